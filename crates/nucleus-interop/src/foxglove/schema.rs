//! Foxglove's message types, as the file descriptors that go into an MCAP schema.

use super::message::Message;

/// Fields of a message, `name:number:kind`. A kind is a word of protocol buffers or the name of a message;
/// `*` before it means many.
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

/// Enumerations inside messages; values are counted from 0.
const ENUMS: [(&str, &str, &str); 3] = [
    ("LinePrimitive", "Type", "LINE_STRIP LINE_LOOP LINE_LIST"),
    ("SceneEntityDeletion", "Type", "MATCHING_ID ALL"),
    ("PackedElementField", "NumericType", "UNKNOWN UINT8 INT8 UINT16 INT16 UINT32 INT32 FLOAT32 FLOAT64"),
];

/// A `google.protobuf.FileDescriptorSet` with all types of `foxglove.SceneUpdate` and `foxglove.PointCloud`.
pub(super) fn file_descriptor_set() -> Vec<u8> {
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
