//! A trade for other programs: all its figures, what was wanted, and what is recommended.

use serde::Serialize;
use serde_json::Value;

use super::text::{recommendation, request_name};
use crate::trade::{Choice, Point, Quantity, Trade, Wish};

/// The document; the fields of the trade follow.
#[derive(Serialize)]
struct Document<'a> {
    /// The name of the scene.
    scene: &'a str,
    wanted: Wanted,
    recommendation: Recommendation<'a>,
    #[serde(flatten)]
    trade: &'a Trade,
}

/// What was wanted.
#[derive(Serialize)]
struct Wanted {
    /// In words.
    text: String,
    /// An error of every quantity without a bound of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<f64>,
    /// Errors of single quantities.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    bounds: Vec<(Quantity, f64)>,
    /// Milliseconds a frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    ms: Option<f64>,
}

#[derive(Serialize)]
struct Recommendation<'a> {
    /// `found`, `nearest`, `unresolved` or `none`.
    choice: &'static str,
    /// The setting with its figures.
    point: Option<&'a Point>,
    /// The quantities in which the references cannot show what is wanted.
    unresolved: Vec<Quantity>,
    /// In words.
    text: String,
}

/// A trade with the recommendation for `wish`, as JSON; `scene` is the name of the scene.
pub fn json(trade: &Trade, scene: &str, wish: &Wish) -> Value {
    let choice = wish.choose(trade);
    let wanted = match wish {
        Wish::Time(ms) => {
            let text = format!("a time of {ms} ms");
            Wanted { text, error: None, bounds: Vec::new(), ms: Some(*ms) }
        }
        Wish::Error(request) => Wanted {
            text: request_name(request),
            error: request.every,
            bounds: request.bounds.clone(),
            ms: None,
        },
    };
    let unresolved = match wish {
        Wish::Time(_) => Vec::new(),
        Wish::Error(request) => request.unresolved(&trade.measure).map(|(quantity, _)| quantity).collect(),
    };
    let recommendation = Recommendation {
        choice: match choice {
            Choice::Found(_) => "found",
            Choice::Nearest(_) => "nearest",
            Choice::Unresolved(_) => "unresolved",
            Choice::None => "none",
        },
        point: choice.point(),
        unresolved,
        text: recommendation(trade, wish),
    };
    // Columns of numbers and names only, which JSON holds.
    serde_json::to_value(Document { scene, wanted, recommendation, trade }).unwrap_or_default()
}
