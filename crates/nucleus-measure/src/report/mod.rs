//! How a trade is shown.
//!
//! | You want to know...                          | Read          |
//! |----------------------------------------------|---------------|
//! | the page with pictures, in one file          | [`html`]      |
//! | its charts                                   | `chart.rs`    |
//! | the table for other programs                 | [`csv`]       |
//! | the words for the terminal                   | [`text`]      |
//! | the page that leads to several of them       | [`index`]     |
//! | how numbers are written                      | [`figure`]    |

mod chart;
mod csv;
mod html;
mod index;
mod text;

pub use csv::csv;
pub use html::{Page, Picture, html};
pub use index::index;
pub use text::{text, time_to};

/// A number with three digits that matter, without zeros at the end: `0.0125`, `24`, `1.5`.
pub fn figure(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A share in percent: `1.25 %`.
pub fn percent(share: f64) -> String {
    format!("{} %", figure(100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_show_three_digits_that_matter() {
        assert_eq!([0.012_345, 24.0, 123.456, 9.996, 0.0].map(figure), ["0.0123", "24", "123", "10", "0"]);
        assert_eq!(percent(0.0125), "1.25 %");
    }
}
