//! Groups of an OBJ file: the faces below each `g` line. They are read apart from the mesh, because few scenes use them.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::error::{ObjError, ObjFault};
use super::statement::{Fault, Statements, words};
use super::uvs::counted;
use crate::files;

/// The corners of the faces of each group, in the order of the file. A face below `g a b` is in both groups.
pub type ObjGroups = BTreeMap<String, Vec<Vec<u32>>>;

/// Reads the groups of a file. Faces above the first `g` line are in none.
///
/// # Errors
/// When the file cannot be read, or a face is malformed; see [`ObjError`].
pub fn read_obj_groups(path: impl AsRef<Path>) -> Result<ObjGroups, ObjError> {
    let path = path.as_ref();
    let groups = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    groups.map_err(|fault| fault.in_file(path))
}

fn read(input: impl BufRead) -> Result<ObjGroups, Fault> {
    let (mut groups, mut open, mut vertices) = (ObjGroups::new(), Vec::new(), 0);
    let mut statements = Statements::new(input);
    while let Some((line, statement)) = statements.next()? {
        let mut words = words(statement);
        match words.next().map(|word| word.bytes) {
            Some(b"v") => vertices += 1,
            Some(b"g") => {
                open = words.map(|word| String::from_utf8_lossy(word.bytes).into_owned()).collect::<Vec<_>>();
                for name in &open {
                    groups.entry(String::clone(name)).or_default();
                }
            }
            Some(b"f") if !open.is_empty() => {
                let corner = |word: super::statement::Word<'_>| {
                    let digits = word.bytes.split(|&byte| byte == b'/').next().unwrap_or_default();
                    let corner = counted(digits, vertices).map(|corner| corner as u32);
                    corner.ok_or_else(|| Fault::Line(line, ObjFault::NotACorner { span: word.span() }))
                };
                let face = words.map(corner).collect::<Result<Vec<u32>, Fault>>()?;
                for name in &open {
                    groups.entry(name.clone()).or_default().push(face.clone());
                }
            }
            _ => {}
        }
    }
    Ok(groups)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_belong_to_the_groups_above_them() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng collar trim\nf 1/1 2/1 3/1\ng sleeve\nf -3 -2 -1\n";
        let groups = read(text.as_bytes()).expect("well formed");
        let names: Vec<_> = groups.keys().map(String::as_str).collect();
        assert_eq!(names, ["collar", "sleeve", "trim"]);
        assert_eq!(groups["trim"], [[0, 1, 2]]);
        assert_eq!(groups["sleeve"], [[0, 1, 2]]);
    }
}
