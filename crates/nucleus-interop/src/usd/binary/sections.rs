//! The sections behind the values: tokens, fields, field sets, paths and specs, and how they are packed.

/// End of a field set.
const END: u32 = u32::MAX;

/// Types of specs, by their number in the format.
#[derive(Clone, Copy)]
pub(super) enum SpecType {
    Attribute = 1,
    Prim = 6,
    Root = 7,
    Relationship = 8,
}

/// A reference to a value.
pub(super) type Rep = u64;

/// A prim or a property, in the order in which they are written.
pub(super) struct Spec {
    /// The name of its path's last element, as a token.
    pub(super) name: u32,
    pub(super) kind: SpecType,
    pub(super) fields: Vec<(u32, Rep)>,
    /// Its prims and properties, by their index among the specs.
    pub(super) children: Vec<usize>,
    pub(super) path: String,
}

pub(super) fn token_section(tokens: &[String]) -> Vec<u8> {
    let text: Vec<u8> = tokens.iter().flat_map(|token| token.bytes().chain([0])).collect();
    let mut bytes = (tokens.len() as u64).to_le_bytes().to_vec();
    bytes.extend((text.len() as u64).to_le_bytes());
    bytes.extend(sized(compressed(&text)));
    bytes
}

pub(super) fn field_section(specs: &[Spec]) -> Vec<u8> {
    let all = || specs.iter().flat_map(|spec| &spec.fields);
    let names: Vec<u32> = all().map(|(name, _)| *name).collect();
    let reps: Vec<u8> = all().flat_map(|(_, rep)| rep.to_le_bytes()).collect();
    let mut bytes = (names.len() as u64).to_le_bytes().to_vec();
    bytes.extend(sized(integers(&names)));
    bytes.extend(sized(compressed(&reps)));
    bytes
}

/// The numbers of the fields of each spec, one set after the other.
pub(super) fn field_set_section(specs: &[Spec]) -> Vec<u8> {
    let mut sets = Vec::new();
    let mut next = 0;
    for spec in specs {
        sets.extend(next..next + spec.fields.len() as u32);
        sets.push(END);
        next += spec.fields.len() as u32;
    }
    let mut bytes = (sets.len() as u64).to_le_bytes().to_vec();
    bytes.extend(sized(integers(&sets)));
    bytes
}

/// The tree of paths, depth first: number, name (negative for a property), and the distance to the next sibling.
pub(super) fn path_section(specs: &[Spec]) -> Vec<u8> {
    let mut columns = [Vec::new(), Vec::new(), Vec::new()];
    add_path(specs, 0, false, &mut columns);
    let count = (specs.len() as u64).to_le_bytes();
    let mut bytes = count.to_vec();
    bytes.extend(count);
    columns.iter().for_each(|column| bytes.extend(sized(integers(column))));
    bytes
}

fn add_path(specs: &[Spec], index: usize, has_sibling: bool, columns: &mut [Vec<u32>; 3]) {
    const LEAF: i32 = -2;
    const ONLY_CHILDREN: i32 = -1;
    const ONLY_SIBLING: i32 = 0;
    let spec = &specs[index];
    let name = spec.name.cast_signed();
    let is_property = matches!(spec.kind, SpecType::Attribute | SpecType::Relationship);
    let at = columns[0].len();
    columns[0].push(index as u32);
    columns[1].push(if is_property { -name } else { name }.cast_unsigned());
    columns[2].push(0);
    for (k, child) in spec.children.iter().enumerate() {
        add_path(specs, *child, k + 1 < spec.children.len(), columns);
    }
    let jump = match (spec.children.is_empty(), has_sibling) {
        (true, true) => ONLY_SIBLING,
        (true, false) => LEAF,
        (false, true) => (columns[0].len() - at) as i32,
        (false, false) => ONLY_CHILDREN,
    };
    columns[2][at] = jump.cast_unsigned();
}

pub(super) fn spec_section(specs: &[Spec]) -> Vec<u8> {
    let paths: Vec<u32> = (0..specs.len() as u32).collect();
    let mut sets = Vec::new();
    let mut next = 0;
    for spec in specs {
        sets.push(next);
        next += spec.fields.len() as u32 + 1;
    }
    let kinds: Vec<u32> = specs.iter().map(|spec| spec.kind as u32).collect();
    let mut bytes = (specs.len() as u64).to_le_bytes().to_vec();
    [paths, sets, kinds].iter().for_each(|column| bytes.extend(sized(integers(column))));
    bytes
}

/// A list of words behind their number.
pub(super) fn words(words: &[u32]) -> Vec<u8> {
    let mut bytes = (words.len() as u64).to_le_bytes().to_vec();
    words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
    bytes
}

/// Bytes behind their number.
fn sized(bytes: Vec<u8>) -> Vec<u8> {
    let mut all = (bytes.len() as u64).to_le_bytes().to_vec();
    all.extend(bytes);
    all
}

/// One chunk of an LZ4 block that consists of literals.
fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut out = vec![0]; // one chunk
    match bytes.len() {
        short @ 0..15 => out.push((short as u8) << 4),
        long => {
            out.push(0xF0);
            let rest = long - 15;
            out.extend(std::iter::repeat_n(255, rest / 255));
            out.push((rest % 255) as u8);
        }
    }
    out.extend(bytes);
    out
}

/// Integers as differences: the commonest, here 0, is two bits; others are two bits and one, two or four bytes.
fn integers(values: &[u32]) -> Vec<u8> {
    let mut codes = vec![0_u8; values.len().div_ceil(4)];
    let (mut differences, mut before) = (Vec::<u8>::new(), 0_i32);
    for (index, value) in values.iter().enumerate() {
        let difference = value.cast_signed().wrapping_sub(before);
        before = value.cast_signed();
        let code = match difference {
            0 => 0,
            -0x80..=0x7F => 1,
            -0x8000..=0x7FFF => 2,
            _ => 3,
        };
        codes[index / 4] |= code << (2 * (index % 4));
        differences.extend(&difference.to_le_bytes()[..[0, 1, 2, 4][code as usize]]);
    }
    let mut bytes = 0_i32.to_le_bytes().to_vec();
    bytes.extend(codes);
    bytes.extend(differences);
    compressed(&bytes)
}
