//! The player in a real browser. Where no Chromium is installed these tests say so and pass.

mod sample;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use nucleus_view::{Player, serve, serve_both};
use sample::Sample;

/// A page that takes longer than this hangs.
const PATIENCE: Duration = Duration::from_secs(180);

/// What a browser shows of a cache.
struct Seen {
    /// The document, after its scripts have run.
    page: String,
    /// Red, green and blue of the screen.
    pixels: Vec<[u8; 3]>,
}

impl Seen {
    fn share(&self, is_wanted: impl Fn(&[u8; 3]) -> bool) -> f64 {
        self.pixels.iter().filter(|pixel| is_wanted(pixel)).count() as f64 / self.pixels.len() as f64
    }

    /// The share of the screen in the red of the first cloth.
    fn cloth(&self) -> f64 {
        self.share(|[red, green, blue]| *red > 80 && *red / 2 > *green && *red / 2 > *blue)
    }
}

/// Where Chromium is; `None`, with a word about it, if it is not installed.
fn chromium() -> Option<&'static Path> {
    let places = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let found = places.map(Path::new).into_iter().find(|path| path.exists());
    if found.is_none() {
        eprintln!("no Chromium here: the player was not tested in a browser");
    }
    found
}

/// Serves the cache and looks at it; `wish` is what stands behind the # of the address.
fn look(chromium: &Path, cache: &Path, wish: &str) -> Seen {
    look_with(chromium, cache, wish, SOFTWARE)
}

/// Graphics without a graphics card.
const SOFTWARE: &[&str] = &["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

fn look_with(chromium: &Path, cache: &Path, wish: &str, graphics: &[&str]) -> Seen {
    look_at(&serve(cache, 0).unwrap(), chromium, wish, graphics)
}

fn look_at(player: &Player, chromium: &Path, wish: &str, graphics: &[&str]) -> Seen {
    look_for(player, chromium, wish, graphics, BUDGETS[0])
}

/// Milliseconds of the page's own time after which it is looked at: what it reads and unpacks does not stop its clock, so
/// on a busy machine the first may be too early.
const BUDGETS: [u32; 3] = [5_000, 20_000, 80_000];

/// Looks at the page ever later, until it shows what is wanted; at the last look it has to.
fn look_until(player: &Player, chromium: &Path, wish: &str, is_there: impl Fn(&Seen) -> bool) -> Seen {
    let look = |budget| look_for(player, chromium, wish, SOFTWARE, budget);
    let mut seen = look(BUDGETS[0]);
    for budget in &BUDGETS[1..] {
        if is_there(&seen) {
            break;
        }
        seen = look(*budget);
    }
    seen
}

fn look_for(player: &Player, chromium: &Path, wish: &str, graphics: &[&str], budget: u32) -> Seen {
    let folder = tempfile::tempdir().unwrap();
    let screen = folder.path().join("screen.png");
    let page = folder.path().join("page.html");
    let mut child = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .args(graphics)
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .args(["--window-size=800,500", "--dump-dom"])
        .arg(format!("--virtual-time-budget={budget}"))
        .arg(format!("--screenshot={}", screen.display()))
        .arg(format!("{}#{wish}", player.url()))
        .stdout(std::fs::File::create(&page).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("the page hangs");
        }
        thread::sleep(Duration::from_millis(20));
    }
    // With `NUCLEUS_SCREENS` set to a folder, what was seen is kept there to be looked at.
    if let Some(kept) = std::env::var_os("NUCLEUS_SCREENS") {
        let name = wish.replace(['&', '='], "_");
        std::fs::copy(&screen, PathBuf::from(kept).join(format!("{name}.png"))).unwrap();
    }
    Seen { page: std::fs::read_to_string(page).unwrap(), pixels: pixels(&screen) }
}

fn pixels(png: &Path) -> Vec<[u8; 3]> {
    let mut decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(png).unwrap()));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    bytes.chunks_exact(info.color_type.samples()).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

fn written(folder: &Path, sample: Sample) -> PathBuf {
    let path = folder.join("run.mcap");
    sample::write(&path, sample);
    path
}

#[test]
fn a_cache_opens_at_the_frame_that_is_asked_for() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let seen =
        look(chromium, &written(folder.path(), Sample { substeps: true, ..Sample::default() }), "frame=12");
    assert!(seen.page.contains(r#"data-state="ready" data-frame="12" data-substep="4""#), "{}", seen.page);
    assert!(seen.page.contains("of 24 · substep 4 of 4 · 0.458 s"), "{}", seen.page);
    for figure in ["<dd class=\"\">1.23&nbsp;%", "0.980", "4,321", "scenes/sample.ron", "flag"] {
        assert!(seen.page.replace(" %", "&nbsp;%").contains(figure), "{figure}");
    }
    assert!(seen.cloth() > 0.03, "the cloth fills {} of the screen", seen.cloth());
}

#[test]
fn colouring_by_strain_takes_the_colour_of_the_cloth_away() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let seen = look(chromium, &written(folder.path(), Sample::default()), "frame=1&strain=4&wireframe");
    assert!(seen.page.contains("+400 %"), "{}", seen.page);
    assert!(seen.cloth() < 0.01, "{} of the screen is red", seen.cloth());
    let pale = seen.share(|[red, green, blue]| *red > 120 && red.abs_diff(*green) < 40 && *blue > 90);
    assert!(pale > 0.03, "hardly strained cloth is pale: {pale}");
}

#[test]
fn a_run_that_was_killed_plays_as_far_as_it_came() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed.mcap");
    let mut recorder = sample::begin(&path, Sample::default());
    (2..=9).for_each(|frame| sample::step(&mut recorder, Sample::default(), frame));
    // As after a kill: the last frame half written, and no index.
    let bytes = std::fs::read(nucleus_cache::part_path(&path)).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 5000]).unwrap();
    drop(recorder);
    let seen = look(chromium, &path, "frame=24");
    assert!(seen.page.contains(r#"data-frame="8""#), "{}", seen.page);
    assert!(seen.page.contains("The run was cut short: frames 1 to 8 are shown."), "{}", seen.page);
    assert!(seen.cloth() > 0.03);
}

#[test]
fn points_that_are_no_numbers_are_counted_and_the_rest_is_shown() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample { broken: true, ..Sample::default() });
    let seen = look(chromium, &path, "frame=20&strain");
    assert!(seen.page.contains(r#"data-frame="20""#), "{}", seen.page);
    assert!(seen.page.contains("Points that are not finite</dt><dd class=\"bad\">22<"), "{}", seen.page);
    let shown = look(chromium, &path, "frame=20").cloth();
    assert!(shown > 0.02, "the cloth fills {shown} of the screen");
}

#[test]
fn a_damaged_frame_is_named_and_the_others_play() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let mut bytes = std::fs::read(&path).unwrap();
    let chunks = chunk_starts(&bytes);
    bytes[chunks[6] + 2000] ^= 0xFF; // the seventh chunk: frame 7
    std::fs::write(&path, bytes).unwrap();
    let seen = look(chromium, &path, "frame=7");
    assert!(seen.page.contains("Frame 7: A frame of the file is damaged."), "{}", seen.page);
    let seen = look(chromium, &path, "frame=8");
    assert!(seen.page.contains(r#"data-frame="8""#), "{}", seen.page);
}

/// Where the chunks of an MCAP file begin.
fn chunk_starts(bytes: &[u8]) -> Vec<usize> {
    let mut starts = Vec::new();
    let mut at = 8;
    while at + 9 < bytes.len() {
        if bytes[at] == 0x06 {
            starts.push(at);
        }
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    starts
}

#[test]
fn a_damaged_index_costs_no_frame() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let mut bytes = std::fs::read(&path).unwrap();
    let in_summary = bytes.len() - 500;
    bytes[in_summary] ^= 0xFF;
    std::fs::write(&path, bytes).unwrap();
    let seen = look(chromium, &path, "frame=24");
    assert!(seen.page.contains(r#"data-frame="24""#), "{}", seen.page);
    assert!(seen.page.contains("its index is damaged"), "{}", seen.page);
}

#[test]
fn a_browser_without_webgl2_is_told_what_it_lacks() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let seen = look_with(chromium, &path, "", &["--disable-3d-apis"]);
    assert!(seen.page.contains(r#"data-state="error""#), "{}", seen.page);
    assert!(seen.page.contains("This browser offers no WebGL2."), "{}", seen.page);
}

#[test]
fn what_is_no_cache_is_refused_in_plain_words() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("holiday.mcap");
    let whole = std::fs::read(written(folder.path(), Sample::default())).unwrap();
    for (bytes, message) in [
        (&b"This is a letter, not a cache."[..], "This is not a cache."),
        (&[][..], "The file is empty."),
        (&whole[..1000], "The file breaks off before its first whole frame."),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let seen = look(chromium, &path, "");
        assert!(seen.page.contains(r#"data-state="error""#), "{message}: {}", seen.page);
        assert!(seen.page.contains(message), "{message}: {}", seen.page);
    }
}

#[test]
fn speed_colours_everything_that_moves_and_has_a_legend() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let seen = look(chromium, &written(folder.path(), Sample::default()), "frame=12&speed=0.5");
    assert!(seen.page.contains("speed, units a second"), "{}", seen.page);
    let warm = seen.share(|[red, green, blue]| {
        *red > 110 && i32::from(*red) > i32::from(*green) + 25 && *green >= *blue
    });
    assert!(warm > 0.01, "the waving end is fast: {warm}");
}

#[test]
fn contact_colours_the_points_and_counts_them() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let with = written(folder.path(), Sample { contacts: true, ..Sample::default() });
    let seen = look(chromium, &with, "frame=12&contacts");
    let page = seen.page.replace('\n', "");
    assert!(page.contains(" tangled</dt><dd>1</dd>") && page.contains(" pinched</dt><dd>0</dd>"), "{page}");
    assert!(page.contains("<dt>Pinched</dt><dd class=\"\">0</dd>"), "the report counts them too: {page}");
    let blue = seen.share(|[red, _, blue]| *blue > 120 && i32::from(*blue) > 2 * i32::from(*red));
    assert!(blue > 0.01 && seen.cloth() < 0.01, "{blue} of the screen is blue");
    let without = folder.path().join("without.mcap");
    sample::write(&without, Sample::default());
    let seen = look(chromium, &without, "frame=12&contacts");
    assert!(seen.cloth() > 0.03, "where contact was not recorded, colours tell objects apart");
}

#[test]
fn a_mesh_that_changes_on_the_way_is_shown_as_it_is_then() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let cache = written(folder.path(), Sample { torn: true, substeps: true, ..Sample::default() });
    let player = serve(&cache, 0).unwrap();
    // Straight there, and by way of the other frames.
    let [before, after, back] = [11, 12, 24].map(|frame| {
        look_until(&player, chromium, &format!("frame={frame}"), |seen| {
            seen.page.contains(&format!("data-frame=\"{frame}\""))
        })
    });
    assert!(after.cloth() < 0.7 * before.cloth(), "{} of {}", after.cloth(), before.cloth());
    assert!(back.cloth() < 0.7 * before.cloth() && back.cloth() > 0.2 * before.cloth(), "{}", back.cloth());
}

#[test]
fn the_player_looks_through_the_camera_of_the_scene_until_one_looks_about() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample { camera: true, ..Sample::default() });
    let through = look(chromium, &path, "frame=24");
    assert!(through.page.contains(">close<"), "{}", through.page);
    let free = look(chromium, &path, "frame=24&camera=none");
    assert!(free.page.contains(">free<"), "{}", free.page);
    assert!(through.cloth() > 2.0 * free.cloth(), "{} is near, {} is framed", through.cloth(), free.cloth());
}

#[test]
fn the_curve_fills_with_the_reports_of_all_frames() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let seen = look(chromium, &written(folder.path(), Sample::default()), "frame=20");
    assert!(seen.page.contains(r#"data-known="23""#), "the start has no report: {}", seen.page);
}

#[test]
fn two_runs_are_shown_one_over_the_other_or_side_by_side_with_their_difference() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| folder.path().join(name).with_extension("mcap"));
    sample::write(&one, Sample::default());
    sample::write(&two, Sample { late: true, ..Sample::default() });
    let player = serve_both(&one, &two, 0).unwrap();
    let net = |seen: &Seen| seen.share(|[red, green, blue]| *blue > 150 && *green > 110 && *red < 150);
    let over = look_until(&player, chromium, "frame=12&difference=0.05", |seen| net(seen) > 0.005);
    assert!(over.page.contains("distance, units"), "{}", over.page);
    assert!(net(&over) > 0.005, "the other run is a net over this one: {}", net(&over));
    let indigo =
        |seen: &Seen| seen.share(|[red, _, blue]| *blue > 90 && i32::from(*blue) > 2 * i32::from(*red));
    let alone = indigo(&look(chromium, &one, "frame=12"));
    let is_there = |seen: &Seen| indigo(seen) > 0.01 && indigo(seen) > 2.0 * alone;
    let beside = look_until(&player, chromium, "frame=12&twin=beside", is_there);
    assert!(is_there(&beside), "{} of the screen, {alone} without the other run", indigo(&beside));
}
