//! A flipped bit costs only the frame that contains it, in finished files and in those of killed runs.

use std::io::Cursor;
use std::ops::Range;

use nucleus_cache::{Detail, ObjectInfo, Playback};

use crate::falling::{self, END, SHOVE, START, Shared};
use crate::torn;

type Cache = Playback<Cursor<Vec<u8>>>;
/// Everything shown at one time sample: frame, time, and each object with its positions.
type Shown = (i32, f64, Vec<(ObjectInfo, Vec<[f32; 3]>)>);

/// Every bit of the first bytes is flipped, and a sample of the others.
const EVERY_BIT: usize = 1024;
const SAMPLE: usize = 11;
/// One file in this many is also recovered, which takes longest.
const RECOVERED: usize = 5;

/// All time samples that can be read completely.
fn shown(cache: &mut Cache) -> Vec<Shown> {
    let mut all = Vec::new();
    for sample in 0..cache.time_samples().len() {
        let (frame, time) = (cache.time_samples()[sample].frame, cache.time_samples()[sample].time);
        let objects = 0..cache.objects().len();
        let read = objects.map(|object| {
            let positions = cache.positions(object, sample)?;
            Ok((cache.object_at(object, sample)?.clone(), positions))
        });
        let read: Result<Vec<_>, nucleus_cache::ReadError> = read.collect();
        all.extend(read.ok().filter(|all| !all.is_empty()).map(|objects| (frame, time, objects)));
    }
    all
}

fn open(bytes: &[u8]) -> Cache {
    Playback::read(Cursor::new(bytes.to_vec())).unwrap_or_else(|error| panic!("{error}"))
}

/// Byte ranges of the chunks of all frames, without those of checkpoints.
fn frames(bytes: &[u8]) -> Vec<(i32, Range<usize>)> {
    let summary = mcap::Summary::read(bytes).unwrap().unwrap();
    let is_frame = |chunk: &&mcap::records::ChunkIndex| {
        let topic = |id: &u16| summary.channels[id].topic.as_str();
        !chunk.message_index_offsets.keys().any(|id| topic(id) == "/checkpoint")
    };
    let place = |chunk: &mcap::records::ChunkIndex| {
        let begin = chunk.chunk_start_offset as usize;
        let frame = START + (chunk.message_end_time as f64 * 24e-9).round() as i32;
        (frame, begin..begin + chunk.chunk_length as usize)
    };
    summary.chunk_indexes.iter().filter(is_frame).map(place).collect()
}

/// Flips a bit. All frames but the one that contains it must be readable, in the file and in the recovered one. That
/// frame may be readable too: not every bit of a compressed frame matters.
fn flip(bytes: &[u8], at: usize, bit: usize, frames: &[(i32, Range<usize>)], sound: &[Shown]) {
    let mut flipped = bytes.to_vec();
    flipped[at] ^= 1 << bit;
    let hit = frames.iter().find(|(_, place)| place.contains(&at)).map(|(frame, _)| *frame);
    let others: Vec<&Shown> = sound.iter().filter(|(frame, ..)| Some(*frame) != hit).collect();
    let is_expected = |found: &[Shown]| found.iter().eq(others.iter().copied()) || found == sound;
    let mut damaged = open(&flipped);
    let found = shown(&mut damaged);
    assert!(is_expected(&found), "byte {at}, bit {bit}: {}", damaged.corruption());
    assert_eq!(damaged.run().scene_text, "Scene()", "byte {at}, bit {bit}");
    if !(8 * at + bit).is_multiple_of(RECOVERED) {
        return;
    }
    let file = Shared::default();
    damaged.recover(file.clone()).unwrap();
    let mut recovered = open(&file.contents());
    assert!(shown(&mut recovered) == found, "byte {at}, bit {bit}, recovered: {}", recovered.corruption());
    assert_eq!(recovered.run(), damaged.run());
    // Without the index, a frame after the last readable one is unknown.
    let last = found.last().map_or(START, |(frame, ..)| *frame);
    let lost = hit.filter(|&frame| found.len() < sound.len() && frame < last);
    assert_eq!(
        recovered.verify().unwrap().frames,
        lost.into_iter().collect::<Vec<_>>(),
        "byte {at}, bit {bit}"
    );
}

fn flip_all_over(bytes: &[u8], every_bit: usize) {
    let frames_at = frames(bytes);
    let sound = shown(&mut open(bytes));
    // A killed run ends behind a frame. No copies follow the last frames, and none are needed.
    let killed = &bytes[..frames_at[frames_at.len() - 2].1.start];
    let shown_till_then = shown(&mut open(killed));
    assert_eq!(open(bytes).run().end, END);
    for (bytes, sound) in [(bytes, sound), (killed, shown_till_then)] {
        let bits = (0..8 * every_bit).chain((8 * every_bit..8 * bytes.len()).step_by(8 * SAMPLE + 3));
        for place in bits {
            flip(bytes, place / 8, place % 8, &frames_at, &sound);
        }
    }
}

#[test]
fn a_flipped_bit_costs_only_the_frame_that_it_is_in() {
    flip_all_over(&falling::whole_run(&falling::with_all_channels()).0, EVERY_BIT);
}

#[test]
fn a_flipped_bit_costs_only_its_frame_where_cloth_tears() {
    for detail in [Detail::Substeps, Detail::Every(2)] {
        flip_all_over(&torn::recorded(&torn::run_info(detail), END), 0);
    }
}

#[test]
fn a_hole_at_the_start_costs_only_the_frames_in_it() {
    let bytes = falling::whole_run(&falling::with_all_channels()).0;
    let sound = shown(&mut open(&bytes));
    for (frame, place) in frames(&bytes) {
        let mut holed = bytes.clone();
        holed[..place.end].fill(0);
        let kept: Vec<&Shown> = sound.iter().filter(|(other, ..)| *other > frame).collect();
        let found = shown(&mut open(&holed));
        if frame <= SHOVE + 1 {
            assert!(found.iter().eq(kept.iter().copied()), "{frame}");
            // The index at the end is lost too.
            holed.truncate(bytes.len() - 20);
            assert!(shown(&mut open(&holed)).iter().eq(kept), "{frame}");
        } else {
            // Both copies of the collider's last position are lost, so no later frame is shown.
            assert_eq!(found, [], "{frame}");
        }
    }
}

#[test]
fn a_cache_is_a_valid_mcap_file_whose_copies_are_valid_mcap_files() {
    let bytes = torn::recorded(&torn::run_info(Detail::Frames), END);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    for record in mcap::read::LinearReader::new(&bytes).unwrap() {
        record.unwrap();
    }
    let messages = mcap::MessageStream::new(&bytes).unwrap().filter(|message| message.is_ok()).count() as u64;
    assert_eq!(messages, summary.stats.as_ref().unwrap().message_count);
    // The start twice, and the mesh of each of two tears; the collider moves in the frame of the first tear.
    assert_eq!(summary.attachment_indexes.len(), 4);
    let mut topologies = Vec::new();
    for index in &summary.attachment_indexes {
        let copy = mcap::read::attachment(&bytes, index).unwrap();
        assert_eq!(
            (copy.name.as_str(), copy.media_type.as_str()),
            ("nucleus.copy", "application/x-nucleus-planes+zstd")
        );
        let planes = zstd::decode_all(&copy.data[..]).unwrap();
        let begin =
            |plane: usize| (0..plane).map(|before| (planes.len() - before).div_ceil(4)).sum::<usize>();
        let copy: Vec<u8> = (0..planes.len()).map(|at| planes[begin(at % 4) + at / 4]).collect();
        let messages = mcap::MessageStream::new(&copy).unwrap().map(|message| message.unwrap());
        let topics: Vec<String> = messages.map(|message| message.channel.topic.clone()).collect();
        topologies.push(topics.iter().filter(|topic| topic.ends_with("/topology")).count());
    }
    assert_eq!(topologies, [2, 1, 1, 2]);
}
