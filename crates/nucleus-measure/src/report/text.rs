//! Text renderings of a trade: terminal, CSV, and the Markdown index.

use super::figures::{figure, percent};
use crate::trade::{
    Choice, Component, ErrorMeasure, Point, Quantity, Reading, Request, Trade, Wish, for_error,
    least_promised,
};

/// Errors for which the recommendation is reported.
pub(super) const ERRORS: [f64; 3] = [0.1, 0.01, 0.001];

/// Text for the terminal.
pub fn text(trade: &Trade) -> String {
    let mut lines = vec![method_text(trade)];
    lines.push(String::new());
    lines.extend(table(trade));
    lines.push(String::new());
    lines.extend(ERRORS.map(|error| time_to(trade, error)));
    if let Some(slope) = trade.slope() {
        lines.push(format!("error scales with time to the power {slope:.2}"));
    }
    lines.extend(troubles(trade));
    lines.join("\n") + "\n"
}

/// How the errors are measured: the frames of each quantity, and the noise of the references.
pub(super) fn method_text(trade: &Trade) -> String {
    let measure = &trade.measure;
    let mut text = format!("Measured: {}.", measure.windows(trade.frames));
    if trade.reference.is_some() {
        let floor = |(quantity, floor): &(Quantity, f64)| format!("{} {}", quantity.name(), percent(*floor));
        let floors: Vec<String> = measure.floors.iter().map(floor).collect();
        text += &format!(
            "\nThe two references differ by: {}. That is the noise of an error, and counts as error. They resolve a \
             wanted error {}.",
            floors.join(", "),
            resolved_from(measure)
        );
    } else {
        text += "\nRead as Classic, cloth is a different material at every setting, so there is no reference; the error is \
                 the strain that 99 % of the edges stay below, RMS over the frames.";
    }
    text
}

/// `from twice the noise on in position and stretch, and from four times in the other quantities`
fn resolved_from(measure: &ErrorMeasure) -> String {
    let quantities = measure.floors.iter().map(|(quantity, _)| *quantity);
    let essential = quantities.filter(|quantity| measure.is_essential(*quantity)).map(Quantity::name);
    match &essential.collect::<Vec<_>>()[..] {
        [] => "from four times the noise on".to_owned(),
        all => format!(
            "from twice the noise on in {}, and from four times in the other quantities",
            all.join(" and ")
        ),
    }
}

/// An error: `0.85 %`, or its bound, `<0.4 %`, within the noise of the references.
pub(super) fn component(trade: &Trade, request: &Request, component: &Component) -> String {
    match request.noise_bound(&trade.measure, component) {
        None => percent(component.error),
        Some(bound) => format!("<{}", percent(bound)),
    }
}

/// `position 0.4 %, stretch 6.1 %`: the error of a setting in each quantity.
pub(super) fn errors(trade: &Trade, request: &Request, point: &Point) -> String {
    let one = |error: &Component| format!("{} {}", error.quantity.name(), component(trade, request, error));
    point.errors.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// `an error of 1 %`, `stretch of 3 %`, `a time of 40 ms`.
pub(super) fn wish_name(wish: &Wish) -> String {
    match wish {
        Wish::Time(ms) => format!("a time of {} ms", figure(*ms)),
        Wish::Error(request) => request_name(request),
    }
}

/// `an error of 1 % and stretch within 3 %`.
pub fn request_name(request: &Request) -> String {
    let every = request.every.map(|error| format!("an error of {}", percent(error)));
    let bound =
        |(quantity, error): &(Quantity, f64)| format!("{} within {}", quantity.name(), percent(*error));
    let all: Vec<String> = every.into_iter().chain(request.bounds.iter().map(bound)).collect();
    all.join(" and ")
}

/// The recommendation in words, one sentence a line.
pub fn recommendation(trade: &Trade, wish: &Wish) -> String {
    let wanted = wish_name(wish);
    let request = match wish {
        Wish::Error(request) => request.clone(),
        Wish::Time(_) => Request::default(),
    };
    let costs = |point: &Point| {
        let errors = errors(trade, &request, point);
        format!("{}, {} ms per frame; errors: {errors}", point.setting, figure(point.ms))
    };
    let mut lines = match wish.choose(trade) {
        Choice::Found(point) => {
            let except = except(trade, &request);
            let mut lines = vec![format!("recommended for {wanted}{except}: {}", costs(point))];
            lines.extend(reason(trade, wish, point));
            return lines.join("\n") + "\n";
        }
        Choice::Nearest(point) => {
            let mut lines = vec![format!("no setting reaches {wanted}; the nearest: {}", costs(point))];
            if let Wish::Error(request) = wish {
                lines.push(format!("it misses {}", misses(trade, request, point)));
            }
            lines
        }
        Choice::Unresolved(point) => vec![format!(
            "the references do not resolve {wanted}; the most accurate setting measured: {}",
            costs(point)
        )],
        Choice::None => {
            let missing = not_measured(trade, &wish.request());
            let reason = missing.unwrap_or_else(|| "no setting is usable".to_owned());
            return format!("{reason}: there is no recommendation for {wanted}\n");
        }
    };
    lines.extend(too_noisy(trade, &request).map(|all| format!("the references do not resolve {all}")));
    lines.join("\n") + "\n"
}

/// The reason why no cheaper setting was chosen, or the accuracy lost to a time limit.
fn reason(trade: &Trade, wish: &Wish, chosen: &Point) -> Option<String> {
    match wish {
        Wish::Error(request) => {
            let cheaper = trade.points.iter().filter(|point| point.ms < chosen.ms && point.is_sound());
            let next = cheaper.max_by(|a, b| a.ms.total_cmp(&b.ms))?;
            let (ms, missed) = (figure(next.ms), misses(trade, request, next));
            Some(format!("the next cheaper, {} in {ms} ms, misses {missed}", next.setting))
        }
        Wish::Time(_) => {
            let best = trade.frontier().last().filter(|best| best.setting != chosen.setting)?;
            let (ms, errors) = (figure(best.ms), errors(trade, &Request::default(), best));
            Some(format!("lost against {} in {ms} ms: {errors}", best.setting))
        }
    }
}

/// `stretch (6 % ± 0.5 %), energy (2 % ± 0.1 %)`: the quantities in which a setting misses a request, with the noise of the
/// references, which counts as error.
fn misses(trade: &Trade, request: &Request, point: &Point) -> String {
    let missed = request.missed(&trade.measure, &point.errors);
    let one = |c: &Component| format!("{} ({} ± {})", c.quantity.name(), percent(c.error), percent(c.floor));
    let all: Vec<String> = missed.map(one).collect();
    match all.is_empty() {
        true => "nothing itself, but the same with more evaluations does".to_owned(),
        false => all.join(", "),
    }
}

/// `position and stretch are not measured`: what a request needs and nothing measures.
fn not_measured(trade: &Trade, request: &Request) -> Option<String> {
    let missing: Vec<&str> = request.unmeasured(&trade.measure).into_iter().map(Quantity::name).collect();
    let verb = if missing.len() == 1 { "is" } else { "are" };
    (!missing.is_empty()).then(|| format!("{} {verb} not measured", missing.join(" and ")))
}

/// `shape below 1.4 %, silhouette below 6.4 %`: quantities with the least error that the references resolve in them.
fn bounds(all: impl Iterator<Item = (Quantity, f64)>) -> Option<String> {
    let name = |(quantity, bound): (Quantity, f64)| format!("{} below {}", quantity.name(), percent(bound));
    let all: Vec<String> = all.map(name).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// The quantities in which the references do not resolve the wanted error.
fn too_noisy(trade: &Trade, request: &Request) -> Option<String> {
    bounds(request.unresolved(&trade.measure))
}

/// The limits of a recommendation, which belong in its own sentence.
fn except(trade: &Trade, request: &Request) -> String {
    let limits = |all| format!(", as far as the references resolve it (not {all})");
    too_noisy(trade, request).map(limits).unwrap_or_default()
}

/// `to 1 %: 12.5 ms per frame with 96 evaluations in 3 substeps`: the recommendation for this error in every quantity.
pub fn time_to(trade: &Trade, error: f64) -> String {
    let (wanted, request) = (percent(error), Request::every(error));
    let said = match for_error(trade, &request) {
        Choice::Found(point) => {
            let except = except(trade, &request);
            format!("{} ms per frame with {}{except}", figure(point.ms), point.setting)
        }
        Choice::Nearest(best) => format!(
            "no setting; the nearest misses {} in {} ms with {}",
            misses(trade, &request, best),
            figure(best.ms),
            best.setting
        ),
        Choice::Unresolved(_) | Choice::None => not_promised(trade, &request),
    };
    format!("to {wanted}: {said}")
}

/// Why there is no setting for a request.
fn not_promised(trade: &Trade, request: &Request) -> String {
    if let Some(missing) = not_measured(trade, request) {
        return format!("not resolved, {missing}");
    }
    match bounds(request.undecided(&trade.measure)) {
        Some(undecided) => format!("not resolved, {undecided}"),
        None => "no setting is sound".to_owned(),
    }
}

/// The settings by increasing cost; `*` marks the Pareto frontier.
fn table(trade: &Trade) -> Vec<String> {
    let measured: Vec<_> = trade.measure.floors.iter().map(|(quantity, _)| *quantity).collect();
    let heads: String = measured.iter().map(|quantity| format!(" {:>13}", quantity.name())).collect();
    let mut lines = vec![format!("  {:>8}{heads} {:>9} {:>9}  setting", "ms/frame", "strain", "largest")];
    for point in &trade.points {
        let of = |quantity: &Quantity| {
            let found = point.errors.iter().find(|error| error.quantity == *quantity);
            let mark = if point.limit == Some(*quantity) { "!" } else { "" };
            let shown = |found| mark.to_owned() + &component(trade, &Request::default(), found);
            format!(" {:>13}", found.map_or("lost".to_owned(), shown))
        };
        let errors: String = measured.iter().map(of).collect();
        let mark = if point.on_frontier { '*' } else { ' ' };
        let own = if point.setting == trade.own { " (the scene's own)" } else { "" };
        let trouble = point.trouble().map(|trouble| format!("; {trouble}")).unwrap_or_default();
        lines.push(format!(
            "{mark} {:>8}{errors} {:>9} {:>9}  {}{own}{trouble}",
            figure(point.ms),
            percent(point.strain),
            percent(point.max_strain),
            point.setting,
        ));
    }
    lines.push(
        "* cheapest for its error; ! the quantity that limits it, or the same with more evaluations; < within the noise \
         of the references: at most this, the noise included"
            .to_owned(),
    );
    lines
}

/// Counts of settings that are not sound.
fn troubles(trade: &Trade) -> Vec<String> {
    let count = |is: &dyn Fn(&Point) -> bool| trade.points.iter().filter(|point| is(point)).count();
    let all = trade.points.len();
    let unresolved = count(&|point| point.pairs_unresolved > 0);
    let first_nonfinite = count(&|point| point.first_nonfinite.is_some());
    let energy = match trade.is_closed {
        true => format!("{} of {all} settings created energy", count(&|point| point.created_energy())),
        false => "wind or animation drives the cloth: created energy is not measured".to_owned(),
    };
    vec![
        energy,
        format!(
            "{unresolved} of {all} settings left pairs unresolved, {first_nonfinite} did not stay finite"
        ),
    ]
}

/// CSV: one setting per line, by increasing cost; times in milliseconds, errors and strains as ratios.
pub fn csv(trade: &Trade) -> String {
    let head = "reading,substeps,collision_iterations,evaluations,resistance_factor,tethers,ms_per_frame,error,limited_by,\
                error_position,error_stretch,error_worst_stretch,error_shape,error_silhouette,error_energy,\
                position_rms,position_max,strain_99,strain_max,energy_created,least_gap,pairs_unresolved,pairs_per_frame,\
                broad_phases_per_frame,first_frame_not_finite,sound,frontier,hash\n";
    let mut text = head.to_owned();
    for point in &trade.points {
        let setting = &point.setting;
        let reading = if setting.reading == Reading::Classic { "classic" } else { "physical" };
        let maybe = |x: Option<f64>| x.map(|x| x.to_string()).unwrap_or_default();
        let of = |quantity| {
            let found = point.errors.iter().find(|component| component.quantity == quantity);
            maybe(found.map(|component| component.error))
        };
        let [position, stretch, worst, shape, silhouette, energy] = Quantity::AGAINST_REFERENCE.map(of);
        let cells = [
            reading.to_owned(),
            setting.substeps.to_string(),
            setting.collision_iterations.to_string(),
            setting.evaluations.to_string(),
            setting.resistance.to_string(),
            setting.tethers.to_string(),
            point.ms.to_string(),
            maybe(point.error),
            point.limit.map(Quantity::name).unwrap_or_default().to_owned(),
            position,
            stretch,
            worst,
            shape,
            silhouette,
            energy,
            maybe(point.position.map(|[rms, _]| rms)),
            maybe(point.position.map(|[_, max]| max)),
            point.strain.to_string(),
            point.max_strain.to_string(),
            maybe(point.created),
            maybe(point.least_gap),
            point.pairs_unresolved.to_string(),
            point.pairs.to_string(),
            point.queries.to_string(),
            point.first_nonfinite.map(|frame| frame.to_string()).unwrap_or_default(),
            point.is_sound().to_string(),
            point.on_frontier.to_string(),
            point.hash.clone(),
        ];
        text += &(cells.join(",") + "\n");
    }
    text
}

/// The Markdown index of several reports. Names are those of the scene files.
pub fn index(trades: &[(String, Trade)], machine: &str) -> String {
    let mut text = format!(
        "# Speed against accuracy\n\nCost and error of settings, scene by scene.\n`nucleus trade SCENE` writes such \
         a report for any scene; `cargo xtask book` rewrites these.\nTimes are milliseconds of processor time per frame, on one \
         core.\n\n{machine}\n\n| Scene | Frames | Settings | Error | To 10 % | To 1 % | To 0.1 % | Slope | Its own setting |\n|---|---|---|---|---|---|---|---|---|\n"
    );
    for (name, trade) in trades {
        let time = |error: f64| match for_error(trade, &Request::every(error)) {
            Choice::Found(point) => format!("{} ms: {}", figure(point.ms), point.setting),
            Choice::Unresolved(_) => "not resolved".to_owned(),
            Choice::Nearest(_) | Choice::None => "no setting".to_owned(),
        };
        let slope = trade.slope().map_or("–".to_owned(), |slope| format!("{slope:.2}"));
        let own = trade.own_point().map_or("–".to_owned(), |own| {
            format!("{} ms, {}", figure(own.ms), own.error.map_or("lost".to_owned(), percent))
        });
        let [to_10, to_1, to_01] = ERRORS.map(time);
        let measure = measure(trade);
        let ([from, to], settings) = (trade.frames, trade.points.len());
        text += &format!(
            "| [{name}]({name}.trade.html) | {from} to {to} | {settings} | {measure} | {to_10} | {to_1} | {to_01} | {slope} | {own} |\n"
        );
    }
    text += "\nThe reports are HTML pages with pictures; download one and open it in a browser. The same folder holds a table \
             (`.csv`) and all figures (`.json`).\nThe slope is the exponent of error against time along the Pareto \
             frontier.\n\n## Unsound settings\n\n";
    for (name, trade) in trades {
        let bad: Vec<String> = trade
            .points
            .iter()
            .filter_map(|point| Some(format!("- {name}, {}: {}\n", point.setting, point.trouble()?)))
            .collect();
        text += &if bad.is_empty() {
            format!("- {name}: all {} settings are sound\n", trade.points.len())
        } else {
            bad.concat()
        };
    }
    text
}

/// The quantities and their frames, and the smallest errors that the references resolve.
fn measure(trade: &Trade) -> String {
    let least = trade.reference.as_ref().and_then(|_| least_promised(&trade.measure));
    let least = least.map(|least| format!("; resolved from {}", percent(least))).unwrap_or_default();
    trade.measure.windows(trade.frames) + &least
}
