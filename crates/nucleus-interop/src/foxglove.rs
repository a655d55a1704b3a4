//! Foxglove's public schemas in an MCAP file: per object and time sample a mesh, and its points as a cloud.
//!
//! In Foxglove and Lichtblick a new entity replaces the old one of the same id, so a deforming mesh is one entity per
//! sample. rerun shows clouds, but no meshes of this schema; so each object is written as both.

use std::io::{Read, Seek};
use std::path::Path;

use nucleus_cache::{ObjectInfo, ObjectKind, TopicFile};

use crate::clip::Clip;
use crate::error::ExportError;
use crate::output::Output;

/// Writes one file in metres.
pub(crate) fn write<R: Read + Seek>(
    clip: &mut Clip<R>,
    out: &Path,
    output: &mut Output,
    progress: &mut dyn FnMut(f64),
) -> Result<(), ExportError> {
    clip.in_metres("foxglove")?;
    let mut file = output.file(out.to_owned())?;
    let mut topics = TopicFile::to_writer(&mut file)?;
    let types = file_descriptor_set();
    let updates = topics.schema("foxglove.SceneUpdate", "protobuf", &types)?;
    let clouds = topics.schema("foxglove.PointCloud", "protobuf", &types)?;
    let mut channels = Vec::new();
    for object in clip.objects() {
        let mesh = match object.faces.is_empty() {
            true => None,
            false => Some(topics.channel(&format!("/{}/mesh", object.name), updates, "protobuf")?),
        };
        channels.push((mesh, topics.channel(&format!("/{}/points", object.name), clouds, "protobuf")?));
    }
    let begin = clip.samples()[0].frame_time;
    for sample in 0..clip.samples().len() {
        let time = ((clip.samples()[sample].frame_time - begin) / clip.fps() * 1e9).round() as u64;
        for (object, (mesh, cloud)) in channels.iter().enumerate() {
            let positions = clip.positions(object, sample)?;
            if let Some(mesh) = mesh {
                topics.send(*mesh, time, &scene_update(clip.object_at(object, sample)?, &positions, time))?;
            }
            topics.send(*cloud, time, &point_cloud(&positions, time))?;
        }
        topics.close_chunk()?;
        progress((sample + 1) as f64 / clip.samples().len() as f64);
    }
    topics.finish()?;
    output.finish(file)
}

/// The frame of reference of all positions.
const FRAME: &str = "world";
/// Quaternion (x, y, z, w) that turns y-up into the z-up of robotics.
const UPRIGHT: [f64; 4] = [std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];

/// A protocol buffer message under construction: fields of a number and a wire type.
#[derive(Debug, Default)]
struct Message(Vec<u8>);

impl Message {
    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    pub fn number(&mut self, field: u32, value: u64) -> &mut Self {
        self.varint(u64::from(field << 3));
        self.varint(value)
    }

    pub fn double(&mut self, field: u32, value: f64) -> &mut Self {
        self.varint(u64::from(field << 3 | 1));
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub fn fixed(&mut self, field: u32, value: u32) -> &mut Self {
        self.varint(u64::from(field << 3 | 5));
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    pub fn bytes(&mut self, field: u32, bytes: &[u8]) -> &mut Self {
        self.varint(u64::from(field << 3 | 2));
        self.varint(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
        self
    }

    pub fn message(&mut self, field: u32, fill: impl FnOnce(&mut Self)) -> &mut Self {
        let mut inner = Self::default();
        fill(&mut inner);
        self.bytes(field, &inner.0)
    }

    fn varint(&mut self, mut value: u64) -> &mut Self {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
        self
    }

    fn doubles(&mut self, values: &[f64]) {
        (1..).zip(values).for_each(|(field, value)| {
            self.double(field, *value);
        });
    }

    fn time(&mut self, field: u32, nanoseconds: u64) -> &mut Self {
        self.message(field, |time| {
            time.number(1, nanoseconds / 1_000_000_000).number(2, nanoseconds % 1_000_000_000);
        })
    }

    fn pose(&mut self, field: u32) -> &mut Self {
        self.message(field, |pose| {
            pose.message(1, |position| position.doubles(&[0.0; 3]));
            pose.message(2, |orientation| orientation.doubles(&UPRIGHT));
        })
    }
}

/// `foxglove.SceneUpdate` with one entity of triangles.
fn scene_update(object: &ObjectInfo, positions: &[[f32; 3]], time: u64) -> Vec<u8> {
    let mut update = Message::default();
    update.message(2, |entity| {
        entity.time(1, time).bytes(2, FRAME.as_bytes()).bytes(3, object.name.as_bytes());
        entity.message(12, |triangles| {
            triangles.pose(1);
            for point in positions {
                triangles.message(2, |message| message.doubles(&point.map(f64::from)));
            }
            let colour = match object.kind {
                ObjectKind::Collider => [0.55, 0.55, 0.55, 1.0],
                _ => [0.72, 0.3, 0.27, 1.0],
            };
            triangles.message(3, |message| message.doubles(&colour));
            let corners: Vec<u8> = object.faces.triangles().flatten().flat_map(u32::to_le_bytes).collect();
            triangles.bytes(5, &corners);
        });
    });
    update.into_bytes()
}

/// `foxglove.PointCloud` with x, y and z as floats.
fn point_cloud(positions: &[[f32; 3]], time: u64) -> Vec<u8> {
    const FLOAT32: u64 = 7;
    let mut cloud = Message::default();
    cloud.time(1, time).bytes(2, FRAME.as_bytes()).pose(3).fixed(4, 12);
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        cloud.message(5, |field| {
            field.bytes(1, name.as_bytes()).fixed(2, 4 * axis as u32).number(3, FLOAT32);
        });
    }
    let data: Vec<u8> = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    cloud.bytes(6, &data);
    cloud.into_bytes()
}

/// Fields of a message, `name:number:type`. A type is a scalar of protocol buffers or the name of a message; `*` before
/// it means repeated.
type Fields = &'static str;

const MESSAGES: [(&str, Fields); 19] = [
    ("Color", "r:1:double g:2:double b:3:double a:4:double"),
    ("Quaternion", "x:1:double y:2:double z:3:double w:4:double"),
    ("Vector3", "x:1:double y:2:double z:3:double"),
    ("Point3", "x:1:double y:2:double z:3:double"),
    ("Pose", "position:1:Vector3 orientation:2:Quaternion"),
    ("KeyValuePair", "key:1:string value:2:string"),
    (
        "ArrowPrimitive",
        "pose:1:Pose shaft_length:2:double shaft_diameter:3:double head_length:4:double head_diameter:5:double \
         color:6:Color",
    ),
    ("CubePrimitive", "pose:1:Pose size:2:Vector3 color:3:Color"),
    ("SpherePrimitive", "pose:1:Pose size:2:Vector3 color:3:Color"),
    (
        "CylinderPrimitive",
        "pose:1:Pose size:2:Vector3 bottom_scale:3:double top_scale:4:double color:5:Color",
    ),
    (
        "LinePrimitive",
        "type:1:enum:LinePrimitive.Type pose:2:Pose thickness:3:double scale_invariant:4:bool points:5:*Point3 \
         color:6:Color colors:7:*Color indices:8:*fixed32",
    ),
    (
        "TriangleListPrimitive",
        "pose:1:Pose points:2:*Point3 color:3:Color colors:4:*Color indices:5:*fixed32",
    ),
    (
        "TextPrimitive",
        "pose:1:Pose billboard:2:bool font_size:3:double scale_invariant:4:bool color:5:Color text:6:string",
    ),
    (
        "ModelPrimitive",
        "pose:1:Pose scale:2:Vector3 color:3:Color override_color:4:bool url:5:string media_type:6:string data:7:bytes",
    ),
    ("SceneEntityDeletion", "timestamp:1:time type:2:enum:SceneEntityDeletion.Type id:3:string"),
    (
        "SceneEntity",
        "timestamp:1:time frame_id:2:string id:3:string lifetime:4:duration frame_locked:5:bool \
         metadata:6:*KeyValuePair arrows:7:*ArrowPrimitive cubes:8:*CubePrimitive spheres:9:*SpherePrimitive \
         cylinders:10:*CylinderPrimitive lines:11:*LinePrimitive triangles:12:*TriangleListPrimitive \
         texts:13:*TextPrimitive models:14:*ModelPrimitive",
    ),
    ("SceneUpdate", "deletions:1:*SceneEntityDeletion entities:2:*SceneEntity"),
    ("PackedElementField", "name:1:string offset:2:fixed32 type:3:enum:PackedElementField.NumericType"),
    (
        "PointCloud",
        "timestamp:1:time frame_id:2:string pose:3:Pose point_stride:4:fixed32 fields:5:*PackedElementField data:6:bytes",
    ),
];

/// Enumerations inside messages; values count from 0.
const ENUMS: [(&str, &str, &str); 3] = [
    ("LinePrimitive", "Type", "LINE_STRIP LINE_LOOP LINE_LIST"),
    ("SceneEntityDeletion", "Type", "MATCHING_ID ALL"),
    ("PackedElementField", "NumericType", "UNKNOWN UINT8 INT8 UINT16 INT16 UINT32 INT32 FLOAT32 FLOAT64"),
];

/// A `google.protobuf.FileDescriptorSet` with all types of `foxglove.SceneUpdate` and `foxglove.PointCloud`.
fn file_descriptor_set() -> Vec<u8> {
    let mut set = Message::default();
    for name in ["Timestamp", "Duration"] {
        set.message(1, |file| {
            let path = format!("google/protobuf/{}.proto", name.to_lowercase());
            file.bytes(1, path.as_bytes()).bytes(2, b"google.protobuf");
            file.message(4, |message| describe(message, name, "seconds:1:int64 nanos:2:int32"));
            file.bytes(12, b"proto3");
        });
    }
    set.message(1, |file| {
        file.bytes(1, b"foxglove.proto").bytes(2, b"foxglove");
        file.bytes(3, b"google/protobuf/timestamp.proto").bytes(3, b"google/protobuf/duration.proto");
        for (name, fields) in MESSAGES {
            file.message(4, |message| describe(message, name, fields));
        }
        file.bytes(12, b"proto3");
    });
    set.into_bytes()
}

/// A `DescriptorProto`.
fn describe(message: &mut Message, name: &str, fields: &str) {
    message.bytes(1, name.as_bytes());
    for field in fields.split_whitespace() {
        message.message(2, |descriptor| describe_field(descriptor, field));
    }
    for (_, name, values) in ENUMS.iter().filter(|(of, ..)| *of == name) {
        message.message(4, |descriptor| {
            descriptor.bytes(1, name.as_bytes());
            for (number, value) in values.split(' ').enumerate() {
                descriptor.message(2, |entry| {
                    entry.bytes(1, value.as_bytes()).number(2, number as u64);
                });
            }
        });
    }
}

/// A `FieldDescriptorProto`.
fn describe_field(descriptor: &mut Message, field: &str) {
    const OPTIONAL: u64 = 1;
    const REPEATED: u64 = 3;
    let mut parts = field.splitn(3, ':');
    let (name, number, kind) = (
        parts.next().unwrap_or_default(),
        parts.next().unwrap_or_default(),
        parts.next().unwrap_or_default(),
    );
    let (label, kind) = kind.strip_prefix('*').map_or((OPTIONAL, kind), |kind| (REPEATED, kind));
    let number = number.bytes().fold(0, |number, digit| 10 * number + u64::from(digit - b'0'));
    let (code, of) = match kind {
        "double" => (1, None),
        "int64" => (3, None),
        "int32" => (5, None),
        "fixed32" => (7, None),
        "bool" => (8, None),
        "string" => (9, None),
        "bytes" => (12, None),
        "time" => (11, Some(".google.protobuf.Timestamp".to_owned())),
        "duration" => (11, Some(".google.protobuf.Duration".to_owned())),
        other => match other.strip_prefix("enum:") {
            Some(name) => (14, Some(format!(".foxglove.{name}"))),
            None => (11, Some(format!(".foxglove.{other}"))),
        },
    };
    descriptor.bytes(1, name.as_bytes()).number(3, number).number(4, label).number(5, code);
    if let Some(of) = of {
        descriptor.bytes(6, of.as_bytes());
    }
}
