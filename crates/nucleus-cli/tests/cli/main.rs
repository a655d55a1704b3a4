//! Tests of the built binary: what it prints, the files it writes, and its exit code.

mod attrs;
mod cache;
mod documentation;
mod extremes;
mod info;
mod initial_state;
mod mistakes;
mod output;
mod play;
mod reference;
mod render;
mod resume;
mod run;
mod sample;
mod scene;
mod signals;
mod slurm;
mod trade;
mod validate;
mod warnings;
mod wedge;
