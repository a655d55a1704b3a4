//! A trade as a table for other programs.

use crate::trade::{Reading, Trade};

/// Every setting on a line, the cheapest first; times in milliseconds, errors and strains as shares.
pub fn csv(trade: &Trade) -> String {
    let head = "reading,substeps,collision_iterations,evaluations,resistance_factor,ms_per_frame,error,\
                position_rms,position_max,strain_99,strain_max,energy_created,least_gap,pairs_unresolved,pairs_per_frame,\
                broad_phases_per_frame,first_frame_not_finite,sound,frontier,hash\n";
    let mut text = head.to_owned();
    for point in &trade.points {
        let setting = &point.setting;
        let reading = if setting.reading == Reading::Classic { "classic" } else { "physical" };
        let maybe = |x: Option<f64>| x.map(|x| x.to_string()).unwrap_or_default();
        let cells = [
            reading.to_owned(),
            setting.substeps.to_string(),
            setting.collision_iterations.to_string(),
            setting.evaluations.to_string(),
            setting.resistance.to_string(),
            point.ms.to_string(),
            maybe(point.error),
            maybe(point.position.map(|[rms, _]| rms)),
            maybe(point.position.map(|[_, max]| max)),
            point.strain.to_string(),
            point.max_strain.to_string(),
            maybe(point.created),
            maybe(point.least_gap),
            point.pairs_unresolved.to_string(),
            point.pairs.to_string(),
            point.searches.to_string(),
            point.lost.map(|frame| frame.to_string()).unwrap_or_default(),
            point.is_sound().to_string(),
            point.on_frontier.to_string(),
            point.hash.clone(),
        ];
        text += &(cells.join(",") + "\n");
    }
    text
}
