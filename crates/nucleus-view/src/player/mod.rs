//! The player: a page in the browser, and the HTTP server of the page and the cache.

mod connection;
mod live;
mod request;
mod response;
mod server;
mod surface;

pub use live::LiveRun;
pub use server::{Player, serve, serve_both, serve_live};
