//! Metadata records of a run, each with a checksum: `nucleus.run`, `nucleus.scene`, `nucleus.cameras`,
//! `nucleus.uvs`, `nucleus.faces` and `nucleus.selections`.

use std::collections::BTreeMap;

use mcap::records::Metadata;

use crate::camera;
use crate::error::OpenError;
use crate::messages::attribute::{CONTACTS, LOOKS, PARTICLES, ROTATION, STRAIN};
use crate::run::{Detail, Packing, Plane, RunInfo, SurfaceShape};
use crate::{face_sets, selections, texture_coordinates};

/// Format version. A reader refuses a higher one.
const FORMAT: u32 = 1;
pub(crate) const PROFILE: &str = "nucleus";
/// Name of the writing program in the file.
pub(crate) const LIBRARY: &str = concat!("nucleus ", env!("CARGO_PKG_VERSION"));
const SCENE: &str = "nucleus.scene";
const CAMERAS: &str = "nucleus.cameras";
const SELECTIONS: &str = "nucleus.selections";
const UVS: &str = "nucleus.uvs";
const FACES: &str = "nucleus.faces";
const RUN: &str = "nucleus.run";
/// Names of the further records of the run, with spaces between; a reader detects a lost record by it.
const FURTHER_RECORDS: &str = "records";
/// In older caches: number of cameras.
const COUNT_OF_CAMERAS: &str = "cameras";
const GROUND: &str = "ground";
/// The ground plane at each frame, a line each, if it moves.
const GROUND_MOTION: &str = "ground motion";
/// Prefix of the key for the particle radius of an object; the object's name follows.
const RADIUS: &str = "radius of ";
/// Prefix of the key for the distance of the particles of a liquid at rest; the object's name follows.
const REST_DISTANCE: &str = "rest distance of ";
/// Prefix of the key for threshold and radius scale of the surface of an object; the object's name follows.
const SURFACE: &str = "surface of ";
const CHECKPOINT: &str = "checkpoint";
const INTERVAL: &str = "interval";
const PACKING: &str = "packing";
const SMALL: &str = "small";
/// Key of a record's checksum over all its other keys and values.
const CHECKSUM: &str = "crc32";
/// Keys that the format defines, whether or not a run has them.
const RESERVED: [&str; 20] = [
    "format",
    "start",
    "end",
    "fps",
    "units_per_metre",
    "record",
    "velocities",
    "version",
    CONTACTS.topic,
    STRAIN.topic,
    LOOKS.topic,
    ROTATION.topic,
    PARTICLES.topic,
    FURTHER_RECORDS,
    COUNT_OF_CAMERAS,
    GROUND,
    GROUND_MOTION,
    CHECKPOINT,
    INTERVAL,
    PACKING,
];

/// Whether the format defines a key of the record `nucleus.run`.
fn is_reserved(key: &str) -> bool {
    RESERVED.contains(&key)
        || key == CHECKSUM
        || [RADIUS, REST_DISTANCE, SURFACE].iter().any(|prefix| key.starts_with(prefix))
}

impl RunInfo {
    pub(crate) fn to_metadata(&self) -> [Metadata; 2] {
        let detail = match self.detail {
            Detail::Frames => "frames".to_owned(),
            Detail::Substeps => "substeps".to_owned(),
            Detail::Every(n) => format!("every {n}"),
        };
        let mut run = self.extra.clone();
        // A default is written as no key, so a further fact of that name would be read as a value.
        run.retain(|key, _| !is_reserved(key));
        run.extend(
            [
                ("format", FORMAT.to_string()),
                ("start", self.start.to_string()),
                ("end", self.end.to_string()),
                ("fps", self.frames_per_second.to_string()),
                ("units_per_metre", self.units_per_metre.to_string()),
                ("record", detail),
                ("velocities", self.velocities.to_string()),
                ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ]
            .map(|(key, value)| (key.to_owned(), value)),
        );
        let also = [(CONTACTS.topic, self.contacts), (STRAIN.topic, self.strain)];
        run.extend(also.map(|(key, is_there)| (key.to_owned(), is_there.to_string())));
        if self.looks {
            run.insert(LOOKS.topic.to_owned(), true.to_string());
        }
        if self.rotation {
            run.insert(ROTATION.topic.to_owned(), true.to_string());
        }
        if self.particles {
            run.insert(PARTICLES.topic.to_owned(), true.to_string());
        }
        let further: Vec<String> = self.extras_to_metadata().map(|record| record.name).collect();
        if !further.is_empty() {
            run.insert(FURTHER_RECORDS.to_owned(), further.join(" "));
        }
        // Keys with default values are left out.
        for (prefix, lengths) in [(RADIUS, &self.radii), (REST_DISTANCE, &self.rest_distances)] {
            run.extend(lengths.iter().map(|(name, length)| (format!("{prefix}{name}"), length.to_string())));
        }
        run.extend(self.surfaces.iter().map(|(name, shape)| {
            (format!("{SURFACE}{name}"), format!("{} {}", shape.threshold, shape.radius_scale))
        }));
        if self.checkpoint > 0 {
            run.insert(CHECKPOINT.to_owned(), self.checkpoint.to_string());
        }
        if self.interval > 1 {
            run.insert(INTERVAL.to_owned(), self.interval.to_string());
        }
        if self.packing == Packing::Small {
            run.insert(PACKING.to_owned(), SMALL.to_owned());
        }
        run.extend(self.ground.map(|plane| (GROUND.to_owned(), numbers_of(&plane))));
        if !self.ground_motion.is_empty() {
            let lines: Vec<String> = self.ground_motion.iter().map(numbers_of).collect();
            run.insert(GROUND_MOTION.to_owned(), lines.join("\n"));
        }
        let scene = [("path", &self.scene_path), ("text", &self.scene_text)]
            .map(|(key, value)| (key.to_owned(), value.clone()));
        [with_checksum(SCENE, scene.into()), with_checksum(RUN, run)]
    }

    /// The records of the cameras, the texture coordinates, the groups and materials, and the selections, if there are any.
    pub(crate) fn extras_to_metadata(&self) -> impl Iterator<Item = Metadata> {
        let cameras =
            (!self.cameras.is_empty()).then(|| with_checksum(CAMERAS, camera::to_keys(&self.cameras)));
        let uvs = (!self.texture_coordinates.is_empty())
            .then(|| with_checksum(UVS, texture_coordinates::to_keys(&self.texture_coordinates)));
        let selections = (!self.selections.is_empty())
            .then(|| with_checksum(SELECTIONS, selections::to_keys(&self.selections)));
        let faces =
            (!self.face_sets.is_empty()).then(|| with_checksum(FACES, face_sets::to_keys(&self.face_sets)));
        cameras.into_iter().chain(uvs).chain(faces).chain(selections)
    }

    /// The run, and the names of its records that are damaged or missing; what they hold is left out.
    pub(crate) fn from_metadata(records: &[Metadata]) -> Result<(Self, Vec<&'static str>), OpenError> {
        let find = |name: &str| {
            let mut named = records.iter().filter(|record| record.name == name);
            named.clone().find(|record| checksum_holds(record)).or(named.next())
        };
        let missing = OpenError::NoRecord { name: RUN };
        let Some(record) = find(RUN) else { return Err(missing) };
        let mut run = Keys(record.metadata.clone());
        let version = run.0.remove("version").unwrap_or_default();
        match run.parse("format") {
            Ok(format) if format > FORMAT => return Err(OpenError::Newer { format, version, known: FORMAT }),
            _ if !checksum_holds(record) => return Err(missing),
            _ => {}
        }
        run.0.remove(CHECKSUM);
        let further = run.0.remove(FURTHER_RECORDS).unwrap_or_default();
        let has_cameras = run.0.remove(COUNT_OF_CAMERAS).is_some();
        let mut lost = Vec::new();
        let mut contents = |name: &'static str| {
            let is_listed = name == SCENE || further.split(' ').any(|listed| listed == name);
            let found = find(name);
            let sound = found.filter(|record| checksum_holds(record));
            if sound.is_none() && (found.is_some() || is_listed || has_cameras && name == CAMERAS) {
                lost.push(name);
            }
            sound.map(|record| record.metadata.clone()).unwrap_or_default()
        };
        let mut scene = contents(SCENE);
        let cameras = camera::from_keys(&contents(CAMERAS));
        let texture_coordinates = texture_coordinates::from_keys(&contents(UVS));
        let face_sets = face_sets::from_keys(&contents(FACES));
        let selections = selections::from_keys(&contents(SELECTIONS));
        let info = Self {
            scene_path: scene.remove("path").unwrap_or_default(),
            scene_text: scene.remove("text").unwrap_or_default(),
            start: run.parse("start")?,
            end: run.parse("end")?,
            frames_per_second: run.parse("fps")?,
            units_per_metre: run.parse("units_per_metre")?,
            detail: run.detail()?,
            interval: if run.0.contains_key(INTERVAL) { run.parse(INTERVAL)? } else { 1 },
            velocities: run.parse("velocities")?,
            contacts: run.flag(CONTACTS.topic),
            strain: run.flag(STRAIN.topic),
            looks: run.flag(LOOKS.topic),
            rotation: run.flag(ROTATION.topic),
            particles: run.flag(PARTICLES.topic),
            ground: run.ground()?,
            ground_motion: run.ground_motion()?,
            radii: run.lengths(RADIUS)?,
            rest_distances: run.lengths(REST_DISTANCE)?,
            surfaces: run.surfaces()?,
            cameras,
            texture_coordinates,
            face_sets,
            selections,
            checkpoint: if run.0.contains_key(CHECKPOINT) { run.parse(CHECKPOINT)? } else { 0 },
            packing: run.packing(),
            version,
            extra: run.0,
        };
        match info.fault() {
            Some(fault) => Err(OpenError::BadValue { key: RUN, value: fault }),
            None => Ok((info, lost)),
        }
    }
}

/// A run whose own record is lost, with the cameras of their record.
pub(crate) fn with_cameras(run: RunInfo, records: &[Metadata]) -> RunInfo {
    let found = records.iter().find(|record| record.name == CAMERAS && checksum_holds(record));
    RunInfo { cameras: found.map(|record| camera::from_keys(&record.metadata)).unwrap_or_default(), ..run }
}

/// What a record holds, for messages.
pub(crate) fn content_of(record: &str) -> &'static str {
    match record {
        SCENE => "the text of the scene",
        CAMERAS => "the cameras",
        UVS => "the texture coordinates",
        FACES => "the groups and materials",
        SELECTIONS => "the selections",
        _ => "a record of the run",
    }
}

/// A metadata record with a checksum: MCAP has none for metadata.
fn with_checksum(name: &str, mut values: BTreeMap<String, String>) -> Metadata {
    values.remove(CHECKSUM);
    let checksum = checksum(&values);
    values.insert(CHECKSUM.to_owned(), checksum);
    Metadata { name: name.to_owned(), metadata: values }
}

/// Whether the checksum of a record matches.
pub(crate) fn checksum_holds(record: &Metadata) -> bool {
    let mut values = record.metadata.clone();
    values.remove(CHECKSUM).is_some_and(|found| found == checksum(&values))
}

fn checksum(values: &BTreeMap<String, String>) -> String {
    let mut hasher = crc32fast::Hasher::new();
    for text in values.iter().flat_map(|(key, value)| [key, value]) {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    format!("{:08x}", hasher.finalize())
}

/// The record `nucleus.run` while it is parsed; the remaining keys become `extra`.
struct Keys(BTreeMap<String, String>);

impl Keys {
    fn parse<T: std::str::FromStr>(&mut self, key: &'static str) -> Result<T, OpenError> {
        let value = self.0.remove(key).unwrap_or_default();
        value.parse().map_err(|_| OpenError::BadValue { key, value })
    }

    /// A boolean key that older caches do not have; missing means false.
    fn flag(&mut self, key: &'static str) -> bool {
        self.0.remove(key).is_some_and(|value| value == "true")
    }

    fn detail(&mut self) -> Result<Detail, OpenError> {
        let value = self.0.remove("record").unwrap_or_default();
        match value.as_str() {
            "frames" => Ok(Detail::Frames),
            "substeps" => Ok(Detail::Substeps),
            other => {
                let every = other.strip_prefix("every ").and_then(|n| n.parse().ok()).filter(|&n| n > 0);
                every.map(Detail::Every).ok_or(OpenError::BadValue { key: "record", value })
            }
        }
    }

    fn packing(&mut self) -> Packing {
        if self.0.remove(PACKING).is_some_and(|packing| packing == SMALL) {
            Packing::Small
        } else {
            Packing::Fast
        }
    }

    /// The shapes of surfaces; removes their keys.
    fn surfaces(&mut self) -> Result<BTreeMap<String, SurfaceShape>, OpenError> {
        let keys: Vec<String> = self.0.keys().filter(|key| key.starts_with(SURFACE)).cloned().collect();
        let mut surfaces = BTreeMap::new();
        for key in keys {
            let text = self.0.remove(&key).unwrap_or_default();
            let numbers = text.split(' ').map(|number| number.parse::<f32>().ok().filter(|x| *x >= 0.0));
            match numbers.collect::<Option<Vec<_>>>().as_deref() {
                Some(&[threshold, radius_scale]) => {
                    surfaces.insert(key[SURFACE.len()..].to_owned(), SurfaceShape { threshold, radius_scale })
                }
                _ => return Err(OpenError::BadValue { key: "surface of", value: text }),
            };
        }
        Ok(surfaces)
    }

    /// The lengths by object whose keys begin with a prefix; removes their keys.
    fn lengths(&mut self, prefix: &'static str) -> Result<BTreeMap<String, f64>, OpenError> {
        let keys: Vec<String> = self.0.keys().filter(|key| key.starts_with(prefix)).cloned().collect();
        let mut lengths = BTreeMap::new();
        for key in keys {
            let text = self.0.remove(&key).unwrap_or_default();
            match text.parse::<f64>() {
                Ok(length) if length >= 0.0 && length.is_finite() => {
                    lengths.insert(key[prefix.len()..].to_owned(), length)
                }
                _ => return Err(OpenError::BadValue { key: prefix.trim_end(), value: text }),
            };
        }
        Ok(lengths)
    }

    /// Six numbers: a point and the normal.
    fn ground(&mut self) -> Result<Option<Plane>, OpenError> {
        let Some(value) = self.0.remove(GROUND) else { return Ok(None) };
        plane(&value).map(Some).ok_or(OpenError::BadValue { key: GROUND, value })
    }

    /// A plane in each line.
    fn ground_motion(&mut self) -> Result<Vec<Plane>, OpenError> {
        let value = self.0.remove(GROUND_MOTION).unwrap_or_default();
        let planes: Option<Vec<Plane>> = value.lines().map(plane).collect();
        planes.ok_or(OpenError::BadValue { key: GROUND_MOTION, value })
    }
}

fn numbers_of(plane: &Plane) -> String {
    let numbers = plane.origin.iter().chain(&plane.normal);
    numbers.map(f64::to_string).collect::<Vec<_>>().join(" ")
}

fn plane(line: &str) -> Option<Plane> {
    let number = |x: &str| x.parse().ok().filter(|x: &f64| x.is_finite());
    let numbers: Vec<f64> = line.split(' ').map(number).collect::<Option<_>>()?;
    match numbers.as_slice() {
        &[x, y, z, a, b, c] => Some(Plane { origin: [x, y, z], normal: [a, b, c] }),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, CameraView, FilmFit};
    use crate::face_sets::{FaceSet, FaceSets};
    use crate::selections::SelectedPoints;
    use crate::texture_coordinates::TextureCoordinates;

    #[test]
    fn metadata_of_a_run_comes_back() {
        let extra = BTreeMap::from([("host".to_owned(), "a b\nc".to_owned())]);
        let ground = Some(Plane { origin: [0.1, -2.0, 0.0], normal: [0.0, 1.0, 1e-9] });
        let raised = Plane { origin: [0.1, 4.0, 0.0], normal: [0.0, 1.0, 0.0] };
        let run = RunInfo {
            scene_path: "a.ron".into(),
            start: -3,
            end: 9,
            extra,
            ground,
            ground_motion: ground.into_iter().chain([raised]).collect(),
            contacts: true,
            radii: BTreeMap::from([("beads of glass".to_owned(), 0.1)]),
            rest_distances: BTreeMap::from([("water".to_owned(), 0.16)]),
            surfaces: BTreeMap::from([(
                "beads of glass".to_owned(),
                SurfaceShape { threshold: 0.7, radius_scale: 1.5 },
            )]),
            ..RunInfo::default()
        };
        for detail in [Detail::Frames, Detail::Substeps, Detail::Every(7)] {
            let run = RunInfo { detail, interval: 3, checkpoint: 24, packing: Packing::Small, ..run.clone() };
            assert_eq!(RunInfo::from_metadata(&run.to_metadata()).unwrap(), (run, Vec::new()));
        }
    }

    #[test]
    fn further_facts_cannot_take_the_names_of_values_of_the_format() {
        let view = CameraView::default();
        let shape = SurfaceShape { threshold: 0.7, radius_scale: 1.5 };
        let complete = RunInfo {
            looks: true,
            rotation: true,
            particles: true,
            ground: Some(Plane { origin: [0.0; 3], normal: [0.0, 1.0, 0.0] }),
            ground_motion: vec![Plane { origin: [0.0; 3], normal: [0.0, 1.0, 0.0] }],
            radii: BTreeMap::from([("beads".to_owned(), 0.1)]),
            surfaces: BTreeMap::from([("beads".to_owned(), shape)]),
            cameras: vec![Camera { name: "shot".to_owned(), fit: FilmFit::Vertical, views: vec![view; 2] }],
            checkpoint: 24,
            packing: Packing::Small,
            ..RunInfo::default()
        };
        let [_, written] = complete.to_metadata();
        let extra: BTreeMap<String, String> = written.metadata;
        // A name of older caches is not written.
        assert!(extra.len() > RESERVED.len(), "every key of the format is among them: {extra:?}");
        let run = RunInfo { extra, ..RunInfo::default() };
        assert_eq!(RunInfo::from_metadata(&run.to_metadata()).unwrap(), (RunInfo::default(), Vec::new()));
    }

    /// The error for a run with one changed value.
    fn refusal(key: &str, value: &str) -> String {
        let [scene, mut run] = RunInfo::default().to_metadata();
        run.metadata.insert(key.to_owned(), value.to_owned());
        RunInfo::from_metadata(&[scene, with_checksum(RUN, run.metadata)]).unwrap_err().to_string()
    }

    #[test]
    fn impossible_values_are_refused_by_name() {
        assert_eq!(refusal("record", "framez"), "the run's `record` cannot be `framez`");
        assert_eq!(refusal("start", ""), "the run's `start` cannot be ``");
        assert!(refusal("fps", "-4").contains("frames per second must be above zero"));
        assert!(refusal("units_per_metre", "NaN").contains("units per metre must be above zero"));
        assert!(refusal("end", "-9").contains("frame -9 ends before frame 1"));
    }

    #[test]
    fn each_record_that_is_lost_or_changed_is_detected() {
        let view = CameraView::default();
        let camera = Camera { name: "shot".to_owned(), fit: FilmFit::Vertical, views: vec![view; 2] };
        let coordinates = TextureCoordinates { corners: vec![0, 0, 0], values: vec![[0.5, 0.25]] };
        let silk = FaceSet { name: "silk".to_owned(), faces: vec![0] };
        let sets = FaceSets { materials: vec![silk], ..FaceSets::default() };
        let run = RunInfo {
            cameras: vec![camera],
            texture_coordinates: BTreeMap::from([("cloth1".to_owned(), coordinates)]),
            face_sets: BTreeMap::from([("cloth1".to_owned(), sets)]),
            selections: vec![SelectedPoints {
                owner: "hem".to_owned(),
                object: "cloth1".to_owned(),
                points: vec![0],
            }],
            ..RunInfo::default()
        };
        let records: Vec<_> = run.to_metadata().into_iter().chain(run.extras_to_metadata()).collect();
        assert_eq!(RunInfo::from_metadata(&records).unwrap(), (run, Vec::new()));
        for at in [CAMERAS, UVS, FACES, SELECTIONS].map(|name| {
            records.iter().position(|record| record.name == name).expect("every record is written")
        }) {
            let lost = |change: fn(&mut Metadata)| {
                let mut records = records.clone();
                change(&mut records[at]);
                RunInfo::from_metadata(&records).unwrap().1
            };
            let name = records[at].name.as_str();
            assert_eq!(lost(|record| _ = record.metadata.insert("more".to_owned(), String::new())), [name]);
            assert_eq!(lost(|record| record.name.push('x')), [name]);
        }
    }

    #[test]
    fn a_changed_scene_is_left_out_and_a_changed_run_is_refused() {
        let run = RunInfo { scene_text: "a".to_owned(), ..RunInfo::default() };
        let [mut scene, mut record] = run.to_metadata();
        scene.metadata.insert("text".to_owned(), "b".to_owned());
        let (read, lost) = RunInfo::from_metadata(&[scene.clone(), record.clone()]).unwrap();
        assert_eq!((read.scene_text.as_str(), lost), ("", vec![SCENE]));
        record.metadata.insert("fps".to_owned(), "25".to_owned());
        assert!(matches!(RunInfo::from_metadata(&[scene, record]), Err(OpenError::NoRecord { .. })));
    }
}
