//! The scene of a sweep, its facts before a run, and the scene at another setting.

use nalgebra::Vector3;
use nucleus_core::{ClothId, Mass, Real};
use nucleus_graph::Simulation;
use nucleus_graph::attributes::{Key, n_base, n_cloth, nucleus};
use nucleus_graph::compile::budget::hanging;
use nucleus_graph::compile::{Object, ObjectKind, Program, compile};
use nucleus_graph::scene::edit::Edit;
use nucleus_graph::scene::{Record, Scene, write_scene};

use super::scene_at::{SettableCloth, SettableScene, own_setting, set_quality};
use super::setting::Setting;
use crate::metrics::deformation::{Edges, size};
use crate::metrics::shape::{Outline, silhouette_difference, surface_distance, triangles};
use crate::result_cache::{Fingerprint, ResultCacheError};

/// Minimum number of frames, the start included.
const FEWEST_FRAMES: i64 = 3;

/// References that do not resolve an error of this size are rejected.
pub(super) const MAX_REFERENCE_UNCERTAINTY: f64 = 0.1;

/// Why a sweep cannot be done.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeError {
    /// The scene does not compile.
    #[error("the scene cannot run: {message}")]
    CannotRun {
        /// The first error.
        message: String,
    },
    /// The scene has no cloth.
    #[error("there is nothing to compare: the scene has no cloth")]
    NothingDynamic,
    /// Fewer frames than `FEWEST_FRAMES`.
    #[error("there is nothing to compare in {frames} frame(s): at least {FEWEST_FRAMES} are needed")]
    TooFewFrames {
        /// Number of frames, the start included.
        frames: i64,
    },
    /// A reference diverged.
    #[error("the reference is not finite from frame {frame} on, so errors cannot be measured against it")]
    ReferenceLost {
        /// The first frame that is not finite.
        frame: i64,
    },
    /// The two references differ too much.
    #[error(
        "the reference does not converge: with {} and with {} evaluations it differs by {:.1} %, \
         which does not resolve an error of {:.0} %; more `--evaluations` make finer references",
        evaluations[0], evaluations[1], 100.0 * uncertainty, 100.0 * MAX_REFERENCE_UNCERTAINTY
    )]
    ReferenceDoesNotConverge {
        /// Evaluations of both.
        evaluations: [f64; 2],
        /// Largest difference in position and stretch, as a share.
        uncertainty: f64,
    },
    /// No cloth moves.
    #[error("there is nothing to compare: in frames {start} to {end} no cloth moves")]
    NothingMoves {
        /// The first frame.
        start: i64,
        /// The last frame.
        end: i64,
    },
    /// Cancelled; finished runs are saved.
    #[error("interrupted")]
    Interrupted,
    /// Results cannot be saved.
    #[error(transparent)]
    Cache(#[from] ResultCacheError),
    /// Runs in other processes did not end well.
    #[error("{0}")]
    Elsewhere(String),
}

/// Version of the measures whose figures stored runs hold.
const MEASURES: u8 = 2;

/// A scene, and its facts before a run.
pub struct Benchmark {
    scene: Scene,
    own: Setting,
    program: Program,
    /// Frames after the start that are simulated and not compared.
    skipped: usize,
    cloths: Vec<SettableCloth>,
    /// The edges of each cloth.
    edges: Vec<Edges>,
    /// Diagonal of the bounding box of all cloth at the start, in metres.
    pub size: f64,
    /// Mass of each point, cloth after cloth, in kilograms.
    pub masses: Vec<f64>,
    /// Gravity in the first frame, in m/s².
    pub gravity: Vector3<f64>,
    /// Whether no wind and no animation adds energy.
    pub is_closed: bool,
    /// Triangles of all cloth, with the points of all cloth numbered through.
    triangles: Vec<[u32; 3]>,
}

impl Benchmark {
    /// Compiles a scene and collects its facts.
    ///
    /// # Errors
    /// When it does not compile, or has nothing to compare.
    pub fn new(scene: &Scene) -> Result<Self, TradeError> {
        let program = compiled(scene)?;
        let span = program.time();
        let frames = span.end - span.start + 1;
        if frames < FEWEST_FRAMES {
            return Err(TradeError::TooFewFrames { frames });
        }
        let (cloths, edges): (Vec<_>, Vec<_>) = cloth_facts(scene, &program).into_iter().unzip();
        if cloths.is_empty() {
            return Err(TradeError::NothingDynamic);
        }
        let cloth = program.model().cloths();
        let size = size(cloth.iter().flat_map(|cloth| &cloth.surface.positions));
        let masses = cloth.iter().flat_map(|cloth| cloth.point_masses()).collect();
        let input = program.first_input();
        let own = own_setting(scene, input.resistance);
        let (gravity, is_closed) = (input.gravity, is_closed(scene));
        let triangles = all_triangles(&program);
        Ok(Self {
            scene: scene.clone(),
            own,
            program,
            skipped: 0,
            cloths,
            edges,
            size,
            masses,
            gravity,
            is_closed,
            triangles,
        })
    }

    /// The same scene, compared from this frame on. Frames before it are simulated, since a cloth moves on from them.
    ///
    /// # Errors
    /// When fewer frames than `FEWEST_FRAMES` are left.
    pub fn comparing_from(mut self, frame: i64) -> Result<Self, TradeError> {
        let span = self.program.time();
        self.skipped = usize::try_from(frame.saturating_sub(span.start + 1)).unwrap_or(0);
        let frames = span.end - span.start + 1 - self.skipped as i64;
        if frames < FEWEST_FRAMES {
            return Err(TradeError::TooFewFrames { frames });
        }
        Ok(self)
    }

    /// Energy of a fall of all cloth by its own size, in joules; 0 without gravity.
    pub fn fall_energy(&self) -> f64 {
        self.masses.iter().sum::<f64>() * self.gravity.norm() * self.size
    }

    /// How two states of all cloth points differ in shape; `None` without faces.
    pub(super) fn outline_of(&self, a: &[Vector3<f64>], b: &[Vector3<f64>]) -> Option<Outline> {
        (!self.triangles.is_empty()).then(|| Outline {
            distance: surface_distance(a, b, &self.triangles) / self.size,
            silhouette: silhouette_difference(a, b, &self.triangles),
        })
    }

    /// The scene's own setting.
    pub fn own(&self) -> Setting {
        self.own
    }

    /// Whether cloth hangs by pins, without tethers.
    pub fn hangs(&self) -> bool {
        self.cloths.iter().any(|cloth| cloth.hangs)
    }

    /// The unchanged scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene's own program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Number of compared frames: all but the first, or those from a later frame on.
    pub fn frames(&self) -> usize {
        let span = self.program.time();
        usize::try_from(span.end - span.start).unwrap_or(0).saturating_sub(self.skipped)
    }

    /// Number of frames that are simulated before the compared ones.
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// The frame before the compared ones, and the last.
    pub fn span(&self) -> [i64; 2] {
        let span = self.program.time();
        [span.start.saturating_add_unsigned(self.skipped as u64), span.end]
    }

    /// The skipped and the compared frames, which are part of the name of a run.
    pub fn window(&self) -> [usize; 2] {
        [self.skipped, self.frames()]
    }

    /// The program of the scene at another setting.
    ///
    /// # Errors
    /// When the scene does not compile at this setting.
    pub fn at(&self, setting: &Setting) -> Result<Program, TradeError> {
        compiled(&self.set(setting))
    }

    /// The scene at another setting, before it is compiled.
    ///
    /// The total mass stays the same: Physical reads `pointMass` per area, Classic per point.
    pub fn set(&self, setting: &Setting) -> Scene {
        self.settable().set(setting)
    }

    /// Edits of the scene file that apply a setting; none for its own.
    pub fn edits(&self, setting: &Setting) -> Vec<Edit> {
        self.settable().edits(setting)
    }

    fn settable(&self) -> SettableScene<'_> {
        SettableScene { scene: &self.scene, own: self.own, cloths: &self.cloths }
    }

    /// Whether there is an edge that can be stretched.
    pub(super) fn has_edges(&self) -> bool {
        self.edges.iter().any(|edges| edges.iter().next().is_some())
    }

    /// Strain of all cloth in a state: the maximum of each figure over the cloths.
    pub fn strain(&self, points: &[Vector3<f64>]) -> crate::metrics::deformation::Strain {
        let mut all = crate::metrics::deformation::Strain::default();
        let mut first = 0;
        for (cloth, edges) in self.cloths.iter().zip(&self.edges) {
            let strain = edges.strain(&points[first..first + cloth.points]);
            first += cloth.points;
            all.rms = crate::metrics::max_or_nan(all.rms, strain.rms);
            all.p99 = crate::metrics::max_or_nan(all.p99, strain.p99);
            all.max = crate::metrics::max_or_nan(all.max, strain.max);
        }
        all
    }

    /// Fingerprints of the scene, without its quality settings, end frame and checks, and of the solver.
    pub fn name(&self) -> String {
        let mut scene = self.scene.clone();
        let neutral = Setting {
            reading: self.own.reading,
            substeps: 1,
            collision_iterations: 1,
            evaluations: 100.0,
            resistance: 1.0,
            tethers: false,
        };
        set_quality(&mut scene.graph, &neutral);
        scene.checks.clear();
        scene.record = Record::default();
        scene.time.end = scene.time.start;
        let text = write_scene(&scene);
        let state: Simulation = Simulation::new(&self.program, 1);
        let mut print = Fingerprint::default().bytes(text.as_bytes()).bytes(&[MEASURES]);
        // Mesh files can change while the scene text does not.
        for object in state.objects() {
            let mut positions = Vec::new();
            object_positions(&state, object, &mut positions);
            let corners = object.faces.corners().iter().flat_map(|corner| corner.to_le_bytes());
            let points = positions.iter().flatten().flat_map(|x| x.to_le_bytes());
            print = print.bytes(&corners.chain(points).collect::<Vec<u8>>());
        }
        format!("{}-{}", print.name(), crate::result_cache::solver_fingerprint().name())
    }
}

/// Replaces `out` by the positions of an object in scene units.
pub fn object_positions<R: Real>(simulation: &Simulation<R>, object: &Object, out: &mut Vec<[f32; 3]>) {
    let (state, units) = (simulation.state(), simulation.units_per_metre());
    match object.kind {
        ObjectKind::Cloth(id) => state.positions(id, units, out),
        ObjectKind::Collider(id) => state.collider_positions(id, units, out),
    }
}

fn compiled(scene: &Scene) -> Result<Program, TradeError> {
    compile(scene).map_err(|found| {
        let first = found.into_iter().find(|one| one.severity == nucleus_graph::scene::Severity::Error);
        TradeError::CannotRun { message: first.map(|first| first.message).unwrap_or_default() }
    })
}

fn cloth_facts(scene: &Scene, program: &Program) -> Vec<(SettableCloth, Edges)> {
    let is_cloth = |object: &&Object| matches!(object.kind, ObjectKind::Cloth(_));
    let cloths = program.objects().iter().filter(is_cloth).zip(program.model().cloths());
    let facts = |(object, cloth): (&Object, &nucleus_core::Cloth)| {
        let even = |mass: Mass| -> f64 {
            let even = nucleus_core::Cloth::new(cloth.surface.clone(), mass, cloth.lists);
            even.point_masses().iter().sum()
        };
        let area = match cloth.mass {
            Mass::PerArea(density) => even(cloth.mass) / density,
            Mass::PerPoint(_) => even(Mass::PerArea(1.0)),
        };
        let node = scene.graph.find(&object.name)?;
        let settable = SettableCloth { node, points: object.points, area, hangs: hangs(program, object) };
        Some((settable, Edges::of(&cloth.surface)))
    };
    cloths.filter_map(facts).collect()
}

/// Whether a cloth of the first nucleus hangs by pins at the first frame, without tethers, and sweeps limit its stretch.
fn hangs(program: &Program, object: &Object) -> bool {
    let ObjectKind::Cloth(ClothId(id)) = object.kind else { return false };
    hanging(id as usize, program.model().cloths(), &program.first_input()).is_some()
}

/// Triangles of all cloth, with the points of all cloth numbered through.
fn all_triangles(program: &Program) -> Vec<[u32; 3]> {
    let mut first = 0;
    let mut all = Vec::new();
    for cloth in program.model().cloths() {
        all.extend(triangles(&cloth.surface.faces, first));
        first += cloth.surface.positions.len() as u32;
    }
    all
}

/// Whether no animation, wind or force adds energy. Conservative: false if in doubt.
fn is_closed(scene: &Scene) -> bool {
    let blows =
        |key: &Key<f64>| scene.graph.of_type(&nucleus::NUCLEUS).any(|(_, node)| node.is_ever_nonzero(key));
    let moves = scene.graph.iter().any(|(_, node)| {
        let quality = ["subSteps", "maxCollisionIterations", "evaluations"];
        node.settings().iter().any(|(name, held)| held.changes() && !quality.contains(name))
    });
    let pushed = scene.graph.of_type(&n_cloth::N_CLOTH).any(|(_, node)| {
        let vector = |key: &Key<[f64; 3]>| node.get(key) != [0.0; 3];
        vector(&n_base::LOCAL_FORCE)
            || vector(&n_base::LOCAL_WIND)
            || node.get(&n_base::REST_LENGTH_SCALE) != 1.0
    });
    !(moves || pushed || blows(&nucleus::WIND_SPEED) && blows(&nucleus::AIR_DENSITY))
}
