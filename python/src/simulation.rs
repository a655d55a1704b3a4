//! A run that Python advances frame by frame.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use nalgebra::Vector3;
use nucleus_core::{MAX_COORDINATE, StateView, StepObserver, SubstepIndex};
use nucleus_graph::audit::Closeness;
use nucleus_graph::checks::{Check, Judge, Outcome};
use nucleus_graph::compile::{Object, ObjectKind, Program};
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;

use crate::array::{Buffer, Rows};
use crate::scene;

/// Time between two looks at the signals of Python.
const SIGNALS_EVERY: Duration = Duration::from_millis(50);

/// A run of a scene, at one of its frames. One thread uses it at a time; others wait.
#[pyclass(frozen, module = "nucleus._nucleus")]
pub struct Simulation {
    program: Program,
    threads: usize,
    run: Mutex<Run>,
}

/// What changes from frame to frame.
struct Run {
    simulation: nucleus_graph::Simulation,
    /// The checks of the scene, over all frames that were solved here.
    judge: Judge,
    /// Positions of colliders at the end of the next frame, in metres, by the index of the object.
    moved: BTreeMap<usize, Vec<Vector3<f64>>>,
    positions: Vec<Buffer>,
    velocities: Vec<Buffer>,
    /// A frame was not finished: the state is in the middle of a time step.
    is_broken: bool,
}

/// Stops the frame when Python has received a signal.
struct Watch {
    looked: Cell<Instant>,
    signal: RefCell<Option<PyErr>>,
}

impl StepObserver for Watch {
    fn substep(&mut self, _: SubstepIndex, _: &dyn StateView) {}

    fn observes_substeps(&self) -> bool {
        false
    }

    fn should_continue(&self) -> ControlFlow<()> {
        if self.looked.get().elapsed() < SIGNALS_EVERY {
            return ControlFlow::Continue(());
        }
        self.looked.set(Instant::now());
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(signal) => {
                self.signal.replace(Some(signal));
                ControlFlow::Break(())
            }
        }
    }
}

/// The simulation, audited if a check needs it.
fn audited(mut simulation: nucleus_graph::Simulation, program: &Program) -> nucleus_graph::Simulation {
    if program.checks().iter().any(Check::needs_audit) {
        simulation.begin_audit(Closeness::Frames);
    }
    simulation
}

impl Run {
    fn new(simulation: nucleus_graph::Simulation, program: &Program) -> Self {
        let buffers = || simulation.objects().iter().map(|_| Buffer::default()).collect();
        let (positions, velocities) = (buffers(), buffers());
        let judge = Judge::new(program.checks(), program.mass());
        Self {
            simulation: audited(simulation, program),
            judge,
            positions,
            velocities,
            moved: BTreeMap::new(),
            is_broken: false,
        }
    }

    /// Refuses a run whose state is in the middle of a time step.
    fn whole(&mut self) -> PyResult<&mut Self> {
        if self.is_broken {
            let why =
                "the simulation was interrupted within a frame: restore a saved state, or make a new one";
            return Err(PyRuntimeError::new_err(why));
        }
        Ok(self)
    }

    /// The state as bytes. They have no place for a move that the next frame has yet to make, which would be lost.
    fn save(&mut self) -> PyResult<Vec<u8>> {
        let run = self.whole()?;
        let Some(object) = run.moved.keys().next() else {
            return Ok(run.simulation.save());
        };
        let name = &run.simulation.objects()[*object].name;
        Err(PyRuntimeError::new_err(format!(
            "`{name}` is to move during the next frame, which a saved state does not hold: save before `move_collider`, or \
             after the next `step`"
        )))
    }

    /// Advances one frame, with the colliders that were given. Returns the report as JSON, or the signal that arrived.
    fn advance(&mut self) -> PyResult<String> {
        self.whole()?;
        let frame = self.simulation.next_frame();
        let moved: Vec<(usize, Vec<Vector3<f64>>)> = std::mem::take(&mut self.moved)
            .into_iter()
            .filter_map(|(object, points)| match self.simulation.objects()[object].kind {
                ObjectKind::Collider(id) => Some((id.0 as usize, points)),
                ObjectKind::Cloth(_) => None,
            })
            .collect();
        // A panic leaves the state in the middle of a time step too.
        self.is_broken = true;
        let mut watch = Watch { looked: Cell::new(Instant::now()), signal: RefCell::new(None) };
        let report = self.simulation.advance_with(
            &mut |_, input| {
                for (collider, points) in &moved {
                    let collider = &mut input.colliders[*collider];
                    collider.start = Vec::new();
                    collider.end.clone_from(points);
                }
            },
            &mut watch,
        );
        if let Some(signal) = watch.signal.into_inner() {
            return Err(signal);
        }
        self.is_broken = false;
        self.judge.see(&report);
        let frame = i32::try_from(frame).unwrap_or(i32::MAX);
        Ok(nucleus_cli::frame_figures(frame, &report.report).to_string())
    }

    /// The index of an object.
    fn object(&self, name: &str) -> PyResult<usize> {
        let objects = self.simulation.objects();
        objects.iter().position(|object| object.name == name).ok_or_else(|| {
            let names: Vec<String> = objects.iter().map(|object| format!("`{}`", object.name)).collect();
            PyKeyError::new_err(format!("there is no object `{name}`; there is {}", names.join(", ")))
        })
    }
}

impl Simulation {
    fn run(&self) -> MutexGuard<'_, Run> {
        self.run.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Uses the run without holding the interpreter, which another thread may need to end its frame.
    fn with<T: Send>(&self, py: Python, using: impl FnOnce(&mut Run) -> T + Send) -> T {
        py.detach(|| using(&mut self.run()))
    }
}

#[pymethods]
impl Simulation {
    /// A run of a scene at its start frame.
    #[new]
    fn new(py: Python, text: String, path: String, threads: usize) -> PyResult<Self> {
        py.detach(|| {
            let (_, program) = scene::compiled(&text, &path)?;
            let run =
                Mutex::new(Run::new(nucleus_graph::Simulation::new(&program, threads.max(1)), &program));
            Ok(Self { program, threads: threads.max(1), run })
        })
    }

    /// Solves the next frame and returns its report as JSON.
    fn advance(&self, py: Python) -> PyResult<String> {
        self.with(py, Run::advance)
    }

    /// The current frame.
    #[getter]
    fn frame(&self, py: Python) -> i64 {
        self.with(py, |run| run.simulation.frame())
    }

    /// Whether the last frame of the scene has been reached.
    #[getter]
    fn is_done(&self, py: Python) -> bool {
        self.with(py, |run| run.simulation.is_done())
    }

    /// Facts that do not change, as JSON: frames, units, objects.
    fn facts(&self) -> String {
        let (program, time) = (&self.program, self.program.time());
        let object = |object: &Object| {
            let kind = match object.kind {
                ObjectKind::Collider(_) => "collider",
                ObjectKind::Cloth(_) if object.faces.is_empty() => "particles",
                ObjectKind::Cloth(_) => "cloth",
            };
            json!({ "name": object.name, "kind": kind, "points": object.points })
        };
        json!({
            "start": time.start, "end": time.end, "fps": time.fps, "units_per_metre": program.units_per_metre(),
            "objects": program.objects().iter().map(object).collect::<Vec<_>>(),
        })
        .to_string()
    }

    /// The faces of an object: the number of corners of each face, and the points of all corners, as unsigned 32-bit
    /// numbers.
    fn faces<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
        let (counts, corners) = self.with(py, |run| {
            let faces = &run.simulation.objects()[run.object(name)?].faces;
            let bytes = |x: u32| x.to_ne_bytes();
            let counts: Vec<u8> = faces.iter().flat_map(|face| bytes(face.len() as u32)).collect();
            Ok::<_, PyErr>((counts, faces.corners().iter().copied().flat_map(bytes).collect::<Vec<u8>>()))
        })?;
        Ok((PyBytes::new(py, &counts), PyBytes::new(py, &corners)))
    }

    /// Positions of an object in scene units.
    fn positions(&self, py: Python, name: &str) -> PyResult<Rows> {
        self.with(py, |run| {
            let index = run.object(name)?;
            let Run { simulation, positions, .. } = run;
            let (state, units) = (simulation.state(), simulation.units_per_metre());
            Ok(positions[index].fill(|out| match simulation.objects()[index].kind {
                ObjectKind::Cloth(id) => state.positions(id, units, out),
                ObjectKind::Collider(id) => state.collider_positions(id, units, out),
            }))
        })
    }

    /// Velocities of cloth or particles in scene units per second.
    fn velocities(&self, py: Python, name: &str) -> PyResult<Rows> {
        self.with(py, |run| {
            let index = run.object(name)?;
            let Run { simulation, velocities, .. } = run;
            let ObjectKind::Cloth(id) = simulation.objects()[index].kind else {
                return Err(PyValueError::new_err(format!(
                    "`{name}` is a collider; only cloth and particles have velocities"
                )));
            };
            let (state, units) = (simulation.state(), simulation.units_per_metre());
            Ok(velocities[index].fill(|out| state.velocities(id, units, out)))
        })
    }

    /// Moves a collider: its positions at the end of the next frame in scene units, three 64-bit floats per point. It moves
    /// there in a straight line from where it is.
    fn move_collider(&self, py: Python, name: &str, points: &[u8]) -> PyResult<()> {
        self.with(py, |run| {
            let run = run.whole()?;
            let index = run.object(name)?;
            let object = &run.simulation.objects()[index];
            let refused = |why: String| Err(PyValueError::new_err(why));
            if !matches!(object.kind, ObjectKind::Collider(_)) {
                return refused(format!("`{name}` is simulated; only colliders can be moved"));
            }
            if self.program.nuclei().len() > 1 {
                return refused("colliders can be moved in scenes with one nucleus only".to_owned());
            }
            if self.program.every() != 1.0 {
                return refused(
                    "colliders can be moved in scenes that are evaluated once a frame".to_owned(),
                );
            }
            if points.len() != 24 * object.points {
                let found = points.len() / 24;
                return refused(format!(
                    "`{name}` has {} points, but positions of {found} were given",
                    object.points
                ));
            }
            let units = run.simulation.units_per_metre();
            let number = |bytes: &[u8]| f64::from_ne_bytes(bytes.try_into().unwrap_or_default()) / units;
            let point =
                |row: &[u8]| Vector3::new(number(&row[0..8]), number(&row[8..16]), number(&row[16..24]));
            let points: Vec<Vector3<f64>> = points.chunks_exact(24).map(point).collect();
            if let Some(bad) = points.iter().position(|point| !point.iter().all(|x| x.is_finite())) {
                return refused(format!("the position of point {bad} of `{name}` is not finite"));
            }
            // The solver keeps a point where it is rather than move it this far, and only counts that.
            let is_far = |point: &Vector3<f64>| point.amax() > MAX_COORDINATE;
            if let Some(far) = points.iter().position(is_far) {
                let limit = MAX_COORDINATE * units;
                return refused(format!(
                    "point {far} of `{name}` is too far away: coordinates are at most {limit:e} ({MAX_COORDINATE:e} m)"
                ));
            }
            run.moved.insert(index, points);
            Ok(())
        })
    }

    /// The state as bytes, to continue later with the same bits.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.with(py, Run::save)?))
    }

    /// Continues from a saved state.
    fn restore(&self, py: Python, state: &[u8]) -> PyResult<()> {
        self.with(py, |run| {
            let restored = nucleus_graph::Simulation::restored(&self.program, self.threads, state);
            let simulation =
                restored.map_err(|error| PyValueError::new_err(format!("cannot restore: {error}")))?;
            run.simulation = audited(simulation, &self.program);
            run.moved.clear();
            run.is_broken = false;
            Ok(())
        })
    }

    /// The checks of the scene over all frames solved so far, as JSON.
    fn checks(&self, py: Python) -> String {
        let check = |outcome: &Outcome| {
            let (figure, frame) = outcome.worst.unzip();
            json!({ "check": outcome.check.to_string(), "passed": outcome.passed, "figure": figure, "frame": frame })
        };
        self.with(py, |run| json!(run.judge.outcomes().iter().map(check).collect::<Vec<_>>()).to_string())
    }
}
