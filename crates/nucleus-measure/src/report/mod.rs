//! Reports of a work-precision curve.
//!
//! | Question                                     | Read          |
//! |----------------------------------------------|---------------|
//! | the HTML page with pictures, in one file     | [`html`]      |
//! | its charts                                   | `chart.rs`    |
//! | the table for other programs                 | [`csv`]       |
//! | all figures and the recommendation for other programs | [`json()`] |
//! | the text for the terminal                    | [`text()`]    |
//! | the Markdown index of several reports        | [`index`]     |
//! | number format                                | [`figure`]    |

mod chart;
mod figures;
mod html;
mod json;
mod text;

pub use figures::{figure, percent};
pub use html::{Page, Picture, html};
pub use json::json;
pub use text::{csv, index, recommendation, request_name, text, time_to};
