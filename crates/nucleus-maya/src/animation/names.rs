//! Names of the attributes of a transform, in full and short, as Maya ASCII writes them.

use crate::scene::{Names, Vector3};

/// A vector: short and full name of the whole, and what follows them in the names of its components.
macro_rules! vector {
    ($short:literal, $long:literal) => {
        vector!($short, $long, "", ["x", "y", "z"], ["X", "Y", "Z"])
    };
    ($short:literal, $long:literal, $number:literal) => {
        vector!($short, $long, $number, ["x", "y", "z"], ["X", "Y", "Z"])
    };
    ($short:literal, $long:literal, $number:literal, [$($s:literal),+], [$($l:literal),+]) => {
        Vector3 {
            whole: &[concat!($short, $number), concat!($long, $number)],
            parts: [$(&[concat!($short, $s, $number), concat!($long, $l, $number)]),+],
        }
    };
}

/// Translation.
pub const TRANSLATE: Vector3 = vector!("t", "translate");
/// Rotation.
pub const ROTATE: Vector3 = vector!("r", "rotate");
/// Scale.
pub const SCALE: Vector3 = vector!("s", "scale");
/// Shear: xy, xz, yz.
pub const SHEAR: Vector3 = vector!("sh", "shear", "", ["xy", "xz", "yz"], ["XY", "XZ", "YZ"]);
/// The pivot of rotation.
pub const ROTATE_PIVOT: Vector3 = vector!("rp", "rotatePivot");
/// Its translation.
pub const ROTATE_PIVOT_TRANSLATE: Vector3 = vector!("rpt", "rotatePivotTranslate");
/// The pivot of scale.
pub const SCALE_PIVOT: Vector3 = vector!("sp", "scalePivot");
/// Its translation.
pub const SCALE_PIVOT_TRANSLATE: Vector3 = vector!("spt", "scalePivotTranslate");
/// The orientation of the rotation axes.
pub const ROTATE_AXIS: Vector3 = vector!("ra", "rotateAxis");
/// The orientation of a joint.
pub const JOINT_ORIENT: Vector3 = vector!("jo", "jointOrient");
/// The inputs of a `multiplyDivide`.
pub(crate) const FACTORS: [Vector3; 2] = [vector!("i1", "input1"), vector!("i2", "input2")];
/// The input of a `reverse`.
pub(crate) const REVERSED: Vector3 = vector!("i", "input");
/// Input, minimum and maximum of a `clamp`.
pub(crate) const CLAMPED: [Vector3; 3] = [
    vector!("ip", "input", "", ["r", "g", "b"], ["R", "G", "B"]),
    vector!("mn", "min", "", ["r", "g", "b"], ["R", "G", "B"]),
    vector!("mx", "max", "", ["r", "g", "b"], ["R", "G", "B"]),
];
/// The translations and the rotations of a `pairBlend`.
pub(crate) const BLENDED: [[Vector3; 2]; 2] = [
    [vector!("it", "inTranslate", "1"), vector!("it", "inTranslate", "2")],
    [vector!("ir", "inRotate", "1"), vector!("ir", "inRotate", "2")],
];
/// The order of rotations.
pub const ROTATE_ORDER: Names = &["ro", "rotateOrder"];
/// The scale that a joint leaves out, which is connected from that of its parent.
pub const INVERSE_SCALE: Vector3 = vector!("is", "inverseScale");
/// Whether a joint leaves out the scale of its parent.
pub const SEGMENT_SCALE: Names = &["ssc", "segmentScaleCompensate"];
/// Whether the parent places it.
pub const INHERITS: Names = &["it", "inheritsTransform"];
/// A matrix between the node and its parent.
pub const OFFSET: Names = &["opm", "offsetParentMatrix"];

/// Whether an attribute is one of a placement, apart from translation, rotation, scale and their order.
pub(crate) fn is_of_placement(name: &str) -> bool {
    let vectors = [
        SHEAR,
        ROTATE_PIVOT,
        ROTATE_PIVOT_TRANSLATE,
        SCALE_PIVOT,
        SCALE_PIVOT_TRANSLATE,
        ROTATE_AXIS,
        JOINT_ORIENT,
        INVERSE_SCALE,
    ];
    let is_in =
        |vector: &Vector3| vector.parts.iter().chain([&vector.whole]).any(|names| names.contains(&name));
    vectors.iter().any(is_in) || [SEGMENT_SCALE, INHERITS, OFFSET].iter().any(|names| names.contains(&name))
}

/// The vector that a component belongs to, and its default.
pub(crate) fn vector_of(part: &str) -> Option<(Vector3, f64)> {
    let all = [(TRANSLATE, 0.0), (ROTATE, 0.0), (SCALE, 1.0)];
    all.into_iter().find(|(vector, _)| vector.parts.iter().any(|names| names.contains(&part)))
}

/// The vector of a name, and its default.
pub(crate) fn vector_of_whole(whole: &str) -> Option<(Vector3, f64)> {
    let all = [(TRANSLATE, 0.0), (ROTATE, 0.0), (SCALE, 1.0)];
    all.into_iter().find(|(vector, _)| vector.whole.contains(&whole))
}

/// What a constraint gives its transform: translation and rotation, in the units of the file.
pub(crate) type Driven = [[f64; 3]; 2];

/// Whether a node is a constraint that is read.
pub(crate) fn is_constraint(kind: &str) -> bool {
    matches!(kind, "parentConstraint" | "pointConstraint" | "orientConstraint")
}

/// The place of an output of a constraint in [`Driven`]: translation or rotation, and the component if it is one.
pub(crate) fn driven_by(name: &str) -> Option<(usize, Option<usize>)> {
    let kinds: [[&str; 2]; 2] = [["ct", "constraintTranslate"], ["cr", "constraintRotate"]];
    let (kind, rest) = kinds.iter().enumerate().find_map(|(kind, [short, long])| {
        name.strip_prefix(long).or_else(|| name.strip_prefix(short)).map(|rest| (kind, rest))
    })?;
    match rest {
        "" => Some((kind, None)),
        "x" | "X" => Some((kind, Some(0))),
        "y" | "Y" => Some((kind, Some(1))),
        "z" | "Z" => Some((kind, Some(2))),
        _ => None,
    }
}
