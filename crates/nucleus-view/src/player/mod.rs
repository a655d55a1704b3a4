//! The player: a page in the browser, and the HTTP server of the page and the cache.

mod connection;
mod request;
mod response;
mod server;

pub use server::{Player, serve, serve_both};
