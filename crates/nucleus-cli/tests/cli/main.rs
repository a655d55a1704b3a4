//! The built binary, as a shell sees it: what it prints, and the code it ends with.

mod attrs;
mod caches;
mod check;
mod extremes;
mod from;
mod info;
mod interrupted;
mod output;
mod play;
mod render;
mod resume;
mod run;
mod sample;
mod scenes;
mod trade;
mod trouble;
