//! The formats that can be written.

use std::path::Path;

/// A format of another tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A Wavefront OBJ file for each object and sample.
    Obj,
    /// A binary PLY file for each object and sample.
    Ply,
    /// A point cache of 3ds Max and Blender for each object, beside its mesh as OBJ.
    Pc2,
    /// A point cache of LightWave, Modo, Houdini and Blender for each object, beside its mesh as OBJ.
    Mdd,
    /// One scene of Pixar's USD, as text, with time samples.
    Usda,
    /// One binary glTF file, with a morph target for each sample.
    Glb,
    /// A VTK file for each object and sample, and a ParaView collection for each object.
    Vtu,
    /// A Maya nCache of 32 bit for each object: a description, and a file for each sample.
    Mc,
    /// The same of 64 bit.
    Mcx,
    /// One MCAP file in Foxglove's public schemas, for Foxglove, Lichtblick and rerun.
    Foxglove,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Obj,
        Self::Ply,
        Self::Pc2,
        Self::Mdd,
        Self::Usda,
        Self::Glb,
        Self::Vtu,
        Self::Mc,
        Self::Mcx,
        Self::Foxglove,
    ];

    /// The word for it on a command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Pc2 => "pc2",
            Self::Mdd => "mdd",
            Self::Usda => "usda",
            Self::Glb => "glb",
            Self::Vtu => "vtu",
            Self::Mc => "mc",
            Self::Mcx => "mcx",
            Self::Foxglove => "foxglove",
        }
    }

    /// Whether everything goes into one file; else it is a folder that is written.
    pub fn is_one_file(self) -> bool {
        matches!(self, Self::Usda | Self::Glb | Self::Foxglove)
    }

    /// The format that the end of a file's name asks for, if any does.
    pub fn of_path(path: &Path) -> Option<Self> {
        let end = path.extension()?.to_str()?.to_ascii_lowercase();
        match end.as_str() {
            "mcap" => Some(Self::Foxglove),
            "usd" => Some(Self::Usda),
            "xml" => Some(Self::Mcx),
            "pvd" => Some(Self::Vtu),
            end => Self::ALL.into_iter().find(|format| format.name() == end),
        }
    }

    /// What is written if no name is given, from the name of the cache without its ending.
    pub fn default_name(self, stem: &str) -> String {
        match self {
            Self::Foxglove => format!("{stem}.foxglove.mcap"),
            Self::Usda | Self::Glb => format!("{stem}.{}", self.name()),
            _ => format!("{stem}_{}", self.name()),
        }
    }
}
