//! The messages, as protocol buffers: fields of a number and a kind, one after the other.

use nucleus_cache::{ObjectInfo, ObjectKind};

/// The frame of reference that everything is in.
const FRAME: &str = "world";
/// Robots have their up along z; the scene's is along y. This turns the one into the other.
const UPRIGHT: [f64; 4] = [std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];

/// A message that is being written.
#[derive(Debug, Default)]
pub(super) struct Message(Vec<u8>);

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
pub(super) fn scene_update(object: &ObjectInfo, positions: &[[f32; 3]], time: u64) -> Vec<u8> {
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
pub(super) fn point_cloud(positions: &[[f32; 3]], time: u64) -> Vec<u8> {
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
