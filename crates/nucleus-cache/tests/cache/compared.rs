//! Comparison of two caches.

use std::io::Cursor;

use nalgebra::Vector3;
use nucleus_cache::{Detail, Difference, Playback, Recorder, RunInfo, compare};
use nucleus_core::{ClothId, ColliderId, ContactState, StateView, StepObserver, SubstepIndex};

use crate::falling::{self, END, Falling, START, SUBSTEPS, Shared};

fn open(bytes: Vec<u8>) -> Playback<Cursor<Vec<u8>>> {
    Playback::read(Cursor::new(bytes)).unwrap()
}

fn run(run: &RunInfo) -> Playback<Cursor<Vec<u8>>> {
    open(falling::whole_run(run).0)
}

/// A run that lags by one frame from frame `from` on.
fn astray(from: i32) -> Playback<Cursor<Vec<u8>>> {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &falling::run_info(), falling::objects()).unwrap();
    recorder.record_start(&Falling::INITIAL).unwrap();
    for frame in START + 1..=END {
        let mut observer = recorder.frame(frame).unwrap();
        let state = Falling { frame: if frame >= from { frame - 1 } else { frame }, substep: SUBSTEPS };
        observer.substep(SubstepIndex { substep: SUBSTEPS, substeps: SUBSTEPS }, &state);
        recorder.end_frame(&()).unwrap();
    }
    recorder.finish().unwrap();
    open(file.contents())
}

#[test]
fn the_recorded_sample_rate_makes_no_difference() {
    let same = compare(&mut run(&falling::run_info()), &mut run(&falling::with_substeps()), 0.0).unwrap();
    assert_eq!((same.differences, same.rms, same.largest), (vec![], 0.0, None));
    assert_eq!(same.time_samples as i32, END - START + 1);
}

#[test]
fn the_first_differing_point_is_named_with_its_distance() {
    let (from, mut one, mut two) = (START + 3, run(&falling::run_info()), astray(START + 3));
    let comparison = compare(&mut one, &mut two, 0.0).unwrap();
    let Difference::Points(first) = &comparison.differences[0] else { panic!("{comparison:?}") };
    let heights = [from - 1, from].map(|frame| Falling { frame, substep: SUBSTEPS }.height());
    assert_eq!((first.frame, first.point, first.points), (from, 0, 4));
    assert_eq!(first.object, falling::objects()[0].1.name);
    assert_eq!(first.distance, 100.0 * f64::from(heights[0] - heights[1]));
    let largest = comparison.largest.unwrap();
    assert_eq!(largest.frame, END, "the gap grows");
    let allowed = compare(&mut one, &mut two, largest.farthest.1).unwrap();
    assert!(allowed.differences.iter().all(|difference| !matches!(difference, Difference::Points(_))));
    assert!(comparison.rms > 0.0 && comparison.rms < largest.farthest.1);
}

#[test]
fn frames_of_the_same_number_are_compared_where_runs_start_apart() {
    let late = RunInfo { start: START + 3, velocities: true, ..falling::run_info() };
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &late, falling::objects()).unwrap();
    recorder.record_start(&Falling { frame: late.start, substep: SUBSTEPS }).unwrap();
    for frame in late.start + 1..=END {
        let mut observer = recorder.frame(frame).unwrap();
        let state = Falling { frame, substep: SUBSTEPS };
        observer.substep(SubstepIndex { substep: SUBSTEPS, substeps: SUBSTEPS }, &state);
        recorder.end_frame(&()).unwrap();
    }
    recorder.finish().unwrap();
    let all = RunInfo { velocities: true, ..falling::run_info() };
    let comparison = compare(&mut run(&all), &mut open(file.contents()), 0.0).unwrap();
    let early = Difference::TimeSample { frame: START, substep: 0, in_first: true };
    assert_eq!((comparison.differences, comparison.time_samples as i32), (vec![early], END - late.start + 1));
}

/// A state whose velocities are twice those of [`Falling`].
struct Faster(Falling);

impl StateView for Faster {
    fn positions(&self, id: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.0.positions(id, units, out);
    }
    fn velocities(&self, id: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.0.velocities(id, 2.0 * units, out);
    }
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        self.0.contacts(out);
        out[0][2] = ContactState::Free;
    }
    fn collider_positions(&self, id: ColliderId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.0.collider_positions(id, units, out);
    }
    fn collider_moved(&self, id: ColliderId) -> bool {
        self.0.collider_moved(id)
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}

#[test]
fn values_that_differ_at_equal_positions_are_a_difference() {
    let all = RunInfo { velocities: true, contacts: true, ..falling::run_info() };
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &all, falling::objects()).unwrap();
    recorder.record_start(&Falling::INITIAL).unwrap();
    for frame in START + 1..=END {
        let mut observer = recorder.frame(frame).unwrap();
        let state = Faster(Falling { frame, substep: SUBSTEPS });
        observer.substep(SubstepIndex { substep: SUBSTEPS, substeps: SUBSTEPS }, &state);
        recorder.end_frame(&()).unwrap();
    }
    recorder.finish().unwrap();
    let name = &falling::objects()[0].1.name;
    let differs = |values, point, points| Difference::Values {
        name: name.clone(),
        values,
        frame: START + 1,
        substep: 1,
        point,
        points,
    };
    let mut other = open(file.contents());
    let found = compare(&mut run(&all), &mut other, 0.0).unwrap().differences;
    assert_eq!(found, [differs("velocities", 0, 4), differs("contacts", 2, 1)]);
    assert_eq!(compare(&mut run(&falling::run_info()), &mut other, 0.0).unwrap().differences, []);
    assert_eq!(compare(&mut run(&all), &mut other, 1e-9).unwrap().differences, []);
}

#[test]
fn frames_and_objects_in_one_cache_only_are_named() {
    let short = RunInfo { end: END - 2, ..falling::run_info() };
    let mut objects = falling::objects();
    objects[1].1.name = "ceiling".to_owned();
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &short, objects).unwrap();
    falling::record(&mut recorder, short.end).unwrap();
    recorder.finish().unwrap();
    let comparison = compare(&mut run(&falling::run_info()), &mut open(file.contents()), 0.0).unwrap();
    let object = |name: &str, in_first| Difference::Object { name: name.to_owned(), in_first };
    let sample = Difference::TimeSample { frame: END - 1, substep: 1, in_first: true };
    assert_eq!(comparison.differences, [object("floor", true), object("ceiling", false), sample]);
    let every = RunInfo { detail: Detail::Every(2), ..falling::run_info() };
    let coarse = compare(&mut run(&every), &mut run(&falling::run_info()), 0.0).unwrap();
    assert!(
        coarse
            .differences
            .iter()
            .all(|difference| matches!(difference, Difference::TimeSample { in_first: false, .. }))
    );
}

/// Flips a bit in the chunk of `frame`.
fn damage(bytes: &mut [u8], frame: i32) {
    let summary = mcap::Summary::read(bytes).unwrap().unwrap();
    let chunk = &summary.chunk_indexes[(frame - START) as usize];
    bytes[(chunk.chunk_start_offset + chunk.chunk_length) as usize - 9] ^= 1;
}

#[test]
fn a_damaged_frame_is_named_and_the_other_frames_are_compared() {
    let sound = falling::whole_run(&falling::run_info()).0;
    let mut damaged = sound.clone();
    damage(&mut damaged, START + 4);
    // Without its index, the frame is missing instead of unreadable.
    let unindexed = damaged[..damaged.len() - 20].to_vec();
    for bytes in [damaged, unindexed] {
        let comparison = compare(&mut open(sound.clone()), &mut open(bytes.clone()), 0.0).unwrap();
        let expected = Difference::Damaged { frame: START + 4, in_first: false };
        assert_eq!(comparison.differences, [expected]);
        assert_eq!(comparison.time_samples as i32, END - START);
        let comparison = compare(&mut open(bytes), &mut astray(START + 6), 0.0).unwrap();
        let [Difference::Damaged { frame, in_first }, Difference::Points(first)] =
            &comparison.differences[..]
        else {
            panic!("{comparison:?}")
        };
        assert_eq!((*frame, *in_first, first.frame), (START + 4, true, START + 6));
    }
}

#[test]
fn a_frame_damaged_in_both_caches_is_named_for_each() {
    let mut bytes = falling::whole_run(&falling::run_info()).0;
    damage(&mut bytes, START + 2);
    let comparison = compare(&mut open(bytes.clone()), &mut open(bytes), 0.0).unwrap();
    let damaged = |in_first| Difference::Damaged { frame: START + 2, in_first };
    assert_eq!(comparison.differences, [damaged(true), damaged(false)]);
}
