//! The page of `nucleus trade`: pictures of the last frame at several settings, and the error over time.

use anyhow::Result;
use nucleus_graph::Simulation;
use nucleus_graph::compile::ObjectKind;
use nucleus_measure::report::{self, Page, Picture, html};
use nucleus_measure::result_cache::ResultCache;
use nucleus_measure::trade::object_positions;
use nucleus_measure::trade::{Benchmark, Point, SweepResult, sweep};
use nucleus_view::{Bounds, Camera, Colouring, Ground, Kind, Object, Style, draw};

/// Width and height of a picture in pixels.
const SIZE: [u32; 2] = [560, 420];

/// The strain that is drawn in full colour.
const FULL_SCALE: f32 = 0.05;

/// Positions of all objects at one time, in scene units.
type State = Vec<Vec<[f32; 3]>>;

/// The page as HTML.
pub fn of(
    scene: &str,
    subject: &Benchmark,
    store: &ResultCache,
    found: &SweepResult,
    recommended: Option<&Point>,
    recommendation: &str,
) -> Result<String> {
    let trade = &found.trade;
    let mut shown: Vec<(String, String, State)> = Vec::new();
    let cheapest = trade.points.iter().find(|point| point.error.is_some());
    let most_accurate = trade.frontier().last().filter(|_| found.references.is_none());
    let selected = [("cheapest", cheapest), ("recommended", recommended), ("most accurate", most_accurate)];
    for (title, point) in selected {
        let Some(point) = point else { continue };
        if let Some(state) = sweep::end(store, subject, &point.setting)? {
            shown.push((title.to_owned(), caption(point), state));
        }
    }
    if let (Some(both), Some(point)) = (&found.references, &trade.reference) {
        let caption =
            format!("{}, in double precision; {} ms per frame", point.setting, report::figure(point.ms));
        shown.push(("reference".to_owned(), caption, both.fine.end.clone()));
    }
    let pictures = pictures(subject, shown)?;
    let named = [("recommended", recommended), ("the scene's own", trade.own_point())];
    let mut series: Vec<(String, Vec<f64>)> = Vec::new();
    for (name, point) in named {
        let twice = name != "recommended" && recommended.is_some_and(|best| best.setting == trade.own);
        if let Some(apart) = point.filter(|_| !twice).and_then(|point| found.divergence(&point.setting)) {
            series.push((name.to_owned(), apart));
        }
    }
    let machine = nucleus_measure::clock::describe_machine().join(" ");
    Ok(html(&Page {
        scene,
        trade,
        recommendation,
        recommended,
        pictures: &pictures,
        series: &series,
        machine: &machine,
    }))
}

fn caption(point: &Point) -> String {
    let error = point.error.map(report::percent).unwrap_or_default();
    let trouble = point.trouble().map(|trouble| format!("; {trouble}")).unwrap_or_default();
    format!("{}; {} ms per frame, meets {error}{trouble}", point.setting, report::figure(point.ms))
}

/// Pictures of the last frame by one camera. Colours show strain, which makes errors visible.
fn pictures(subject: &Benchmark, shown: Vec<(String, String, State)>) -> Result<Vec<Picture>> {
    let rest = rest(subject);
    let (mut stage, mut all) = (Bounds::default(), Bounds::default());
    for (_, _, state) in &shown {
        let objects = objects(subject, &rest, state);
        stage.merge(&Bounds::of_interest(&objects));
        objects.iter().for_each(|object| all.include(object.positions));
    }
    let ground = if all.is_empty() { Ground::None } else { Ground::At(all.low[1]) };
    let colouring = Colouring::Strain { full_scale: FULL_SCALE };
    let style = Style { size: SIZE, colouring, ground, ..Style::default() };
    let camera = Camera::framing(&stage, SIZE);
    let drawn = shown.into_iter().map(|(title, caption, state)| {
        let png = draw(&objects(subject, &rest, &state), &camera, &style).to_png()?;
        Ok(Picture { title, caption, png })
    });
    drawn.collect()
}

/// Positions of all objects at the start.
fn rest(subject: &Benchmark) -> State {
    let start: Simulation = Simulation::new(subject.program(), 1);
    let mut rest: State = vec![Vec::new(); start.objects().len()];
    for (object, out) in start.objects().iter().zip(&mut rest) {
        object_positions(&start, object, out);
    }
    rest
}

fn objects<'a>(subject: &'a Benchmark, rest: &'a State, state: &'a State) -> Vec<Object<'a>> {
    let all = subject.program().objects().iter().zip(rest).zip(state);
    // A state stored by another build may have other meshes; those objects are not drawn.
    let fitting = all.filter(|((_, rest), positions)| rest.len() == positions.len());
    fitting
        .map(|((object, rest), positions)| Object {
            name: &object.name,
            kind: match object.kind {
                ObjectKind::Cloth(_) if object.faces.is_empty() => Kind::Particles,
                ObjectKind::Cloth(_) => Kind::Cloth,
                ObjectKind::Collider(_) => Kind::Collider,
            },
            faces: &object.faces,
            positions,
            rest: Some(rest),
            radius: object.radius.map(|radius| radius as f32),
            looks: None,
        })
        .collect()
}
