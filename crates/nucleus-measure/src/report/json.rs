//! A trade for other programs: all its figures, what was wanted, and what is recommended.

use serde::Serialize;
use serde_json::Value;

use super::text::{recommendation, wish_name};
use crate::trade::{Choice, Point, Quantity, Trade, Wish};

/// The document; the fields of the trade follow.
#[derive(Serialize)]
struct Document<'a> {
    /// The name of the scene.
    scene: &'a str,
    wanted: Wanted<'a>,
    recommendation: Recommendation<'a>,
    #[serde(flatten)]
    trade: &'a Trade,
}

/// What was wanted.
#[derive(Serialize)]
struct Wanted<'a> {
    /// In words.
    text: String,
    /// An error of every quantity without a bound of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<f64>,
    /// Errors of single quantities.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    bounds: &'a [(Quantity, f64)],
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
    /// The quantities in which the references cannot show what is wanted, those that are not measured first.
    unresolved: Vec<Quantity>,
    /// In words.
    text: String,
}

/// A trade with the recommendation for `wish`, as JSON; `scene` is the name of the scene.
pub fn json(trade: &Trade, scene: &str, wish: &Wish) -> Value {
    let choice = wish.choose(trade);
    let (error, bounds, ms) = match wish {
        Wish::Time(ms) => (None, &[][..], Some(*ms)),
        Wish::Error(request) => (request.every, &request.bounds[..], None),
    };
    let wanted = Wanted { text: wish_name(wish), error, bounds, ms };
    let unresolved = match wish {
        Wish::Time(_) => Vec::new(),
        Wish::Error(request) => {
            let differ = request.unresolved(&trade.measure).map(|(quantity, _)| quantity);
            request.unmeasured(&trade.measure).into_iter().chain(differ).collect()
        }
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
