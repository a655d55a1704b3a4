//! The player: a page in the browser, and the little server that gives it the page and the cache.

mod arriving;
mod deadline;
mod page;
mod range;
mod request;
mod response;
mod server;

pub use server::{Player, serve, serve_both};
