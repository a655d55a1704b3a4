//! The player in Chromium. Without Chromium these tests print a note and pass.

mod sample;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use nucleus_view::{Player, serve, serve_both};
use sample::Sample;

/// Time after which a page counts as hanging.
const PAGE_TIMEOUT: Duration = Duration::from_secs(180);

/// The page of a cache, as the browser shows it.
struct Shown {
    /// The document, after its scripts have run.
    page: String,
    /// Red, green and blue of the screenshot.
    pixels: Vec<[u8; 3]>,
}

impl Shown {
    fn share(&self, is_wanted: impl Fn(&[u8; 3]) -> bool) -> f64 {
        self.pixels.iter().filter(|pixel| is_wanted(pixel)).count() as f64 / self.pixels.len() as f64
    }

    /// The fraction of the screen in the red of the first cloth.
    fn cloth(&self) -> f64 {
        self.share(|[red, green, blue]| *red > 80 && *red / 2 > *green && *red / 2 > *blue)
    }
}

/// The path of Chromium; `None`, with a note, if it is not installed.
fn chromium() -> Option<&'static Path> {
    let places = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let found = places.map(Path::new).into_iter().find(|path| path.exists());
    if found.is_none() {
        eprintln!("no Chromium here: the player was not tested in a browser");
    }
    found
}

/// Serves a cache and opens it; `options` follow the # of the address.
fn look(chromium: &Path, cache: &Path, options: &str) -> Shown {
    look_with(chromium, cache, options, SOFTWARE)
}

/// Software rendering.
const SOFTWARE: &[&str] = &["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

fn look_with(chromium: &Path, cache: &Path, options: &str, graphics: &[&str]) -> Shown {
    look_at(&serve(cache, 0).unwrap(), chromium, options, graphics)
}

fn look_at(player: &Player, chromium: &Path, options: &str, graphics: &[&str]) -> Shown {
    look_for(player, chromium, options, graphics, BUDGETS[0])
}

/// Virtual time in milliseconds until the screenshot. It does not stop while the page reads and unpacks, so the first may
/// be too short on a busy machine.
const BUDGETS: [u32; 3] = [5_000, 20_000, 80_000];

/// Opens the page with growing budgets until the condition holds; returns the last result.
fn look_until(player: &Player, chromium: &Path, options: &str, is_there: impl Fn(&Shown) -> bool) -> Shown {
    let look = |budget| look_for(player, chromium, options, SOFTWARE, budget);
    let mut shown = look(BUDGETS[0]);
    for budget in &BUDGETS[1..] {
        if is_there(&shown) {
            break;
        }
        shown = look(*budget);
    }
    shown
}

fn look_for(player: &Player, chromium: &Path, options: &str, graphics: &[&str], budget: u32) -> Shown {
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
        .arg(format!("{}#{options}", player.url()))
        .stdout(std::fs::File::create(&page).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > PAGE_TIMEOUT {
            child.kill().unwrap();
            panic!("the page hangs");
        }
        thread::sleep(Duration::from_millis(20));
    }
    // The environment variable `NUCLEUS_SCREENS` names a folder for the screenshots.
    if let Some(kept) = std::env::var_os("NUCLEUS_SCREENS") {
        let name = options.replace(['&', '='], "_");
        std::fs::copy(&screen, PathBuf::from(kept).join(format!("{name}.png"))).unwrap();
    }
    Shown { page: std::fs::read_to_string(page).unwrap(), pixels: pixels(&screen) }
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
fn a_cache_opens_at_the_requested_frame() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let shown =
        look(chromium, &written(folder.path(), Sample { substeps: true, ..Sample::default() }), "frame=12");
    assert!(shown.page.contains(r#"data-state="ready" data-frame="12" data-substep="4""#), "{}", shown.page);
    assert!(shown.page.contains("of 24 · substep 4 of 4 · 0.458 s"), "{}", shown.page);
    for figure in ["<dd class=\"\">1.23&nbsp;%", "0.980", "4,321", "scenes/sample.ron", "flag"] {
        assert!(shown.page.replace(" %", "&nbsp;%").contains(figure), "{figure}");
    }
    assert!(shown.cloth() > 0.03, "the cloth fills {} of the screen", shown.cloth());
}

#[test]
fn the_members_of_a_constraint_are_listed_and_drawn_when_chosen() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let player = serve(written(folder.path(), Sample { selected: true, ..Sample::default() }), 0).unwrap();
    let yellow = |shown: &Shown| shown.share(|[r, g, b]| *r > 170 && *g > 110 && *b < *g / 2 && *r > *g);
    let listed = |shown: &Shown| shown.page.contains("33 points of flag");
    let hidden = look_until(&player, chromium, "frame=1", listed);
    let drawn = look_until(&player, chromium, "frame=1&select=hoist", |shown| yellow(shown) > 1e-4);
    assert!(listed(&hidden) && hidden.page.contains("hoist"), "{}", hidden.page);
    assert!(yellow(&hidden) < 1e-5 && yellow(&drawn) > 1e-4, "{} {}", yellow(&hidden), yellow(&drawn));
}

#[test]
fn picked_points_are_drawn_and_named_as_components_of_a_scene() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let player = serve(written(folder.path(), Sample::default()), 0).unwrap();
    let green = |shown: &Shown| shown.share(|[r, g, b]| *g > 230 && *r < 190 && *b > 190 && *b < 245);
    let options = "frame=1&pick=flag.vtx[3:6]&pick=flag.vtx[40]&pick=flag.vtx[7]";
    let named = |shown: &Shown| shown.page.contains(r#""flag.vtx[3:7]", "flag.vtx[40]""#);
    let none = look_until(&player, chromium, "frame=1", |shown| shown.cloth() > 0.03);
    let picked = look_until(&player, chromium, options, |shown| named(shown) && green(shown) > 1e-4);
    assert!(named(&picked), "{}", picked.page);
    assert!(picked.page.contains("<dt>Picked points</dt><dd>6</dd>"), "{}", picked.page);
    assert!(green(&none) < 1e-5 && green(&picked) > 1e-4, "{} {}", green(&none), green(&picked));
}

#[test]
fn colouring_by_strain_replaces_the_colour_of_the_cloth() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let shown = look(chromium, &written(folder.path(), Sample::default()), "frame=1&strain=4&wireframe");
    assert!(shown.page.contains("+400 %"), "{}", shown.page);
    assert!(shown.cloth() < 0.01, "{} of the screen is red", shown.cloth());
    let pale = shown.share(|[red, green, blue]| *red > 120 && red.abs_diff(*green) < 40 && *blue > 90);
    assert!(pale > 0.03, "hardly strained cloth is pale: {pale}");
}

#[test]
fn a_link_hides_objects() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    assert!(look(chromium, &path, "frame=12&hide=ball").cloth() > 0.03);
    let hidden = look(chromium, &path, "frame=12&hide=flag&hide=ball").cloth();
    assert!(hidden < 0.01, "{hidden} of the screen: the button that plays is red too");
}

#[test]
fn a_killed_run_plays_up_to_its_last_complete_frame() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed.mcap");
    let mut recorder = sample::begin(&path, Sample::default());
    (2..=9).for_each(|frame| sample::step(&mut recorder, Sample::default(), frame));
    // As after a kill: the last frame half written, and no index.
    let bytes = std::fs::read(nucleus_cache::part_path(&path)).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 5000]).unwrap();
    drop(recorder);
    let shown = look(chromium, &path, "frame=24");
    assert!(shown.page.contains(r#"data-frame="8""#), "{}", shown.page);
    assert!(shown.page.contains("The run is incomplete: frames 1 to 8 are shown."), "{}", shown.page);
    assert!(shown.cloth() > 0.03);
}

#[test]
fn points_that_are_not_finite_are_counted_and_the_others_are_shown() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample { broken: true, ..Sample::default() });
    let shown = look(chromium, &path, "frame=20&strain");
    assert!(shown.page.contains(r#"data-frame="20""#), "{}", shown.page);
    assert!(shown.page.contains("Points that are not finite</dt><dd class=\"bad\">22<"), "{}", shown.page);
    let cloth = look(chromium, &path, "frame=20").cloth();
    assert!(cloth > 0.02, "the cloth fills {cloth} of the screen");
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
    let shown = look(chromium, &path, "frame=7");
    assert!(shown.page.contains("Frame 7: A frame of the file is damaged."), "{}", shown.page);
    let shown = look(chromium, &path, "frame=8");
    assert!(shown.page.contains(r#"data-frame="8""#), "{}", shown.page);
}

#[test]
fn a_damaged_frame_of_an_incomplete_run_is_named_beside_its_frames() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let mut bytes = std::fs::read(&path).unwrap();
    let chunks = chunk_starts(&bytes);
    bytes[chunks[6] + 2000] ^= 0xFF;
    std::fs::write(&path, &bytes[..chunks[9]]).unwrap();
    let shown = look(chromium, &path, "frame=7");
    for notice in
        ["The run is incomplete: frames 1 to 9 are shown.", "Frame 7: A frame of the file is damaged."]
    {
        assert!(shown.page.contains(notice), "{notice}: {}", shown.page);
    }
}

#[test]
fn a_cache_that_was_deleted_is_said_to_be_gone() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let player = serve(&path, 0).unwrap();
    std::fs::remove_file(&path).unwrap();
    let shown = look_at(&player, chromium, "", SOFTWARE);
    assert!(shown.page.contains("The cache is no longer there."), "{}", shown.page);
}

#[test]
fn particles_have_their_recorded_radius_and_colour() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let player = serve(written(folder.path(), Sample { dust: true, ..Sample::default() }), 0).unwrap();
    let green = |shown: &Shown| shown.share(|[red, green, blue]| *green > 50 && *green / 2 > *red.max(blue));
    // The ball beside the particles is in the picture too.
    let shown = look_until(&player, chromium, "frame=12", |shown| green(shown) > 0.005);
    assert!(green(&shown) > 0.005, "{} of the screen is green", green(&shown));
    let bright = shown.share(|[red, green, blue]| *green > 170 && *green / 2 > *red.max(blue));
    assert!(bright == 0.0, "half transparent particles are dark before the background: {bright}");
}

#[test]
fn particles_and_their_surface_take_the_colour_of_speed_particles_that_of_contacts_and_none_of_strain() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let sample = Sample { dust: true, blown: true, bare: true, contacts: true, ..Sample::default() };
    let player = serve(written(folder.path(), sample), 0).unwrap();
    let green = |shown: &Shown| shown.share(|[red, green, blue]| *green > 50 && *green / 2 > *red.max(blue));
    let red = |shown: &Shown| shown.share(|[red, green, blue]| *red > 50 && *red / 2 > *green.max(blue));
    let blue = |shown: &Shown| shown.share(|[red, _, blue]| *blue > 60 && *blue / 2 > *red);
    let look = |options: &str, share: &dyn Fn(&Shown) -> f64| {
        look_until(&player, chromium, &format!("frame=12{options}"), |shown| share(shown) > 0.01)
    };
    assert!(green(&look("", &green)) > 0.01);
    // 1.2 units per second is far above the scale.
    let fast = look("&speed=0.5", &red);
    assert!(red(&fast) > 0.01 && green(&fast) < 1e-3, "{} is red, {} is green", red(&fast), green(&fast));
    assert!(fast.page.contains("speed, units per second"), "{}", fast.page);
    let surface = look("&speed=0.5&surface", &red);
    assert!(red(&surface) > 0.01 && surface.page.contains(">surface · "), "{}", surface.page);
    let touching = look("&contacts", &blue);
    assert!(blue(&touching) > 0.01 && green(&touching) < 1e-3, "{} is blue", blue(&touching));
    assert!(touching.page.replace('\n', "").contains(" touching</dt><dd>4</dd>"), "{}", touching.page);
    let wet = look("&contacts&surface", &blue);
    assert!(blue(&wet) > 0.01 && green(&wet) < 1e-3, "{} of the screen is blue", blue(&wet));
    assert!(wet.page.replace('\n', "").contains(" touching</dt><dd>4</dd>"), "particles are counted");
    // All particles are at 1.2 units per second.
    assert!(
        look("&speed", &|shown| f64::from(u8::from(shown.page.contains(">2</span>"))))
            .page
            .contains(">2</span>")
    );
    let strained = look("&strain=0.1", &green);
    assert!(green(&strained) > 0.01 && strained.page.contains(r#"id="legend" hidden="#), "{}", strained.page);
}

#[test]
fn a_frame_that_the_other_run_does_not_have_shows_no_difference() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [whole, short] = ["whole", "short"].map(|name| folder.path().join(name).with_extension("mcap"));
    sample::write(&whole, Sample::default());
    let mut recorder = sample::begin(&short, Sample::default());
    (2..=6).for_each(|frame| sample::step(&mut recorder, Sample::default(), frame));
    recorder.finish().unwrap();
    let player = serve_both(&whole, &short, 0).unwrap();
    let net = |shown: &Shown| shown.share(|[red, green, blue]| *blue > 150 && *green > 110 && *red < 150);
    let both = look_until(&player, chromium, "frame=6&difference=0.05", |shown| net(shown) > 0.005);
    assert!(net(&both) > 0.005 && !both.page.contains("The other run ends"), "{}", both.page);
    let says = |shown: &Shown| shown.page.contains("The other run ends at frame 6.");
    let alone = look_until(&player, chromium, "frame=12&difference=0.05", says);
    assert!(says(&alone) && alone.page.contains("<dt>Distance, largest</dt><dd>–</dd>"), "{}", alone.page);
    assert!(
        10.0 * net(&alone) < net(&both) && alone.cloth() > 0.03,
        "the cloth keeps its colour: {}",
        alone.cloth()
    );
}

#[test]
fn a_tilted_ground_plane_is_drawn_as_it_is() {
    let Some(chromium) = chromium() else { return };
    let shown = |sample: Sample| {
        let folder = tempfile::tempdir().unwrap();
        let player = serve(written(folder.path(), sample), 0).unwrap();
        look_until(&player, chromium, "frame=3", |shown| shown.page.contains("data-frame=\"3\""))
    };
    let level = shown(Sample::default());
    let tilted = shown(Sample { plane: Some(0.0), tilt: 0.5, ..Sample::default() });
    let differ = level.pixels.iter().zip(&tilted.pixels).filter(|(a, b)| a[0].abs_diff(b[0]) > 3).count();
    let share = differ as f64 / level.pixels.len() as f64;
    assert!(share > 0.1, "{share} of the screen differs from a level floor");
}

/// The offsets of the chunks of an MCAP file.
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
    let shown = look(chromium, &path, "frame=24");
    assert!(shown.page.contains(r#"data-frame="24""#), "{}", shown.page);
    assert!(shown.page.contains("its index is damaged"), "{}", shown.page);
}

#[test]
fn a_browser_without_webgl2_gets_an_error_that_names_it() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), Sample::default());
    let shown = look_with(chromium, &path, "", &["--disable-3d-apis"]);
    assert!(shown.page.contains(r#"data-state="error""#), "{}", shown.page);
    assert!(shown.page.contains("This browser offers no WebGL2."), "{}", shown.page);
}

#[test]
fn a_file_that_is_not_a_cache_is_refused_with_a_reason() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("holiday.mcap");
    let whole = std::fs::read(written(folder.path(), Sample::default())).unwrap();
    for (bytes, message) in [
        (&b"This is a letter, not a cache."[..], "This is not a cache."),
        (&[][..], "The file is empty."),
        (&whole[..1000], "The file ends before its first complete frame."),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let shown = look(chromium, &path, "");
        assert!(shown.page.contains(r#"data-state="error""#), "{message}: {}", shown.page);
        assert!(shown.page.contains(message), "{message}: {}", shown.page);
    }
}

#[test]
fn speed_colours_moving_objects_and_has_a_legend() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let shown = look(chromium, &written(folder.path(), Sample::default()), "frame=12&speed=0.5");
    assert!(shown.page.contains("speed, units per second"), "{}", shown.page);
    let warm = shown.share(|[red, green, blue]| {
        *red > 110 && i32::from(*red) > i32::from(*green) + 25 && *green >= *blue
    });
    assert!(warm > 0.01, "the waving end is fast: {warm}");
}

#[test]
fn contact_states_colour_the_points_and_are_counted() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let with = written(folder.path(), Sample { contacts: true, ..Sample::default() });
    let shown = look(chromium, &with, "frame=12&contacts");
    let page = shown.page.replace('\n', "");
    assert!(
        page.contains(" intersecting</dt><dd>1</dd>") && page.contains(" compressed</dt><dd>0</dd>"),
        "{page}"
    );
    assert!(
        page.contains("<dt>Points compressed</dt><dd class=\"\">0</dd>"),
        "the report counts them too: {page}"
    );
    let blue = shown.share(|[red, _, blue]| *blue > 120 && i32::from(*blue) > 2 * i32::from(*red));
    assert!(blue > 0.01 && shown.cloth() < 0.01, "{blue} of the screen is blue");
    let without = folder.path().join("without.mcap");
    sample::write(&without, Sample::default());
    let shown = look(chromium, &without, "frame=12&contacts");
    assert!(shown.cloth() > 0.03, "without recorded contact states, each object keeps its colour");
}

#[test]
fn a_mesh_that_changes_is_shown_with_the_topology_of_each_frame() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let cache = written(folder.path(), Sample { torn: true, substeps: true, ..Sample::default() });
    let player = serve(&cache, 0).unwrap();

    let [before, after, back] = [11, 12, 24].map(|frame| {
        look_until(&player, chromium, &format!("frame={frame}"), |shown| {
            shown.page.contains(&format!("data-frame=\"{frame}\""))
        })
    });
    assert!(after.cloth() < 0.7 * before.cloth(), "{} of {}", after.cloth(), before.cloth());
    assert!(back.cloth() < 0.7 * before.cloth() && back.cloth() > 0.2 * before.cloth(), "{}", back.cloth());
}

#[test]
fn the_player_follows_the_camera_of_the_scene_unless_it_is_switched_off() {
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
    let shown = look(chromium, &written(folder.path(), Sample::default()), "frame=20");
    assert!(shown.page.contains(r#"data-known="23""#), "the start has no report: {}", shown.page);
}

#[test]
fn two_runs_are_shown_over_each_other_or_side_by_side_with_their_difference() {
    let Some(chromium) = chromium() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| folder.path().join(name).with_extension("mcap"));
    sample::write(&one, Sample::default());
    sample::write(&two, Sample { late: true, ..Sample::default() });
    let player = serve_both(&one, &two, 0).unwrap();
    let net = |shown: &Shown| shown.share(|[red, green, blue]| *blue > 150 && *green > 110 && *red < 150);
    let over = look_until(&player, chromium, "frame=12&difference=0.05", |shown| net(shown) > 0.005);
    assert!(over.page.contains("distance, units"), "{}", over.page);
    assert!(net(&over) > 0.005, "the edges of the other run are drawn over this one: {}", net(&over));
    let indigo =
        |shown: &Shown| shown.share(|[red, _, blue]| *blue > 90 && i32::from(*blue) > 2 * i32::from(*red));
    let alone = indigo(&look(chromium, &one, "frame=12"));
    let is_there = |shown: &Shown| indigo(shown) > 0.01 && indigo(shown) > 2.0 * alone;
    let beside = look_until(&player, chromium, "frame=12&twin=beside", is_there);
    assert!(is_there(&beside), "{} of the screen, {alone} without the other run", indigo(&beside));
}
