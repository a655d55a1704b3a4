//! Names of the attributes of a transform, in full and short, as Maya ASCII writes them.

use crate::scene::{Names, Vector3};

/// Translation.
pub const TRANSLATE: Vector3 = Vector3 {
    whole: &["t", "translate"],
    parts: [&["tx", "translateX"], &["ty", "translateY"], &["tz", "translateZ"]],
};
/// Rotation.
pub const ROTATE: Vector3 =
    Vector3 { whole: &["r", "rotate"], parts: [&["rx", "rotateX"], &["ry", "rotateY"], &["rz", "rotateZ"]] };
/// Scale.
pub const SCALE: Vector3 =
    Vector3 { whole: &["s", "scale"], parts: [&["sx", "scaleX"], &["sy", "scaleY"], &["sz", "scaleZ"]] };
/// Shear: xy, xz, yz.
pub const SHEAR: Vector3 = Vector3 {
    whole: &["sh", "shear"],
    parts: [&["shxy", "shearXY"], &["shxz", "shearXZ"], &["shyz", "shearYZ"]],
};
/// The pivot of rotation.
pub const ROTATE_PIVOT: Vector3 = Vector3 {
    whole: &["rp", "rotatePivot"],
    parts: [&["rpx", "rotatePivotX"], &["rpy", "rotatePivotY"], &["rpz", "rotatePivotZ"]],
};
/// Its translation.
pub const ROTATE_PIVOT_TRANSLATE: Vector3 = Vector3 {
    whole: &["rpt", "rotatePivotTranslate"],
    parts: [
        &["rptx", "rotatePivotTranslateX"],
        &["rpty", "rotatePivotTranslateY"],
        &["rptz", "rotatePivotTranslateZ"],
    ],
};
/// The pivot of scale.
pub const SCALE_PIVOT: Vector3 = Vector3 {
    whole: &["sp", "scalePivot"],
    parts: [&["spx", "scalePivotX"], &["spy", "scalePivotY"], &["spz", "scalePivotZ"]],
};
/// Its translation.
pub const SCALE_PIVOT_TRANSLATE: Vector3 = Vector3 {
    whole: &["spt", "scalePivotTranslate"],
    parts: [
        &["sptx", "scalePivotTranslateX"],
        &["spty", "scalePivotTranslateY"],
        &["sptz", "scalePivotTranslateZ"],
    ],
};
/// The orientation of the rotation axes.
pub const ROTATE_AXIS: Vector3 = Vector3 {
    whole: &["ra", "rotateAxis"],
    parts: [&["rax", "rotateAxisX"], &["ray", "rotateAxisY"], &["raz", "rotateAxisZ"]],
};
/// The orientation of a joint.
pub const JOINT_ORIENT: Vector3 = Vector3 {
    whole: &["jo", "jointOrient"],
    parts: [&["jox", "jointOrientX"], &["joy", "jointOrientY"], &["joz", "jointOrientZ"]],
};
/// The order of rotations.
pub const ROTATE_ORDER: Names = &["ro", "rotateOrder"];
/// Whether a joint leaves out the scale of its parent.
pub const SEGMENT_SCALE: Names = &["ssc", "segmentScaleCompensate"];
/// Whether the parent places it.
pub const INHERITS: Names = &["it", "inheritsTransform"];
/// A matrix between the node and its parent.
pub const OFFSET: Names = &["opm", "offsetParentMatrix"];

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
