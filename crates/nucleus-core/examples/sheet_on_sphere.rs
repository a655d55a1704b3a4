//! A sheet falls on a sphere: the solver as a library, without scenes and files.

use nucleus_core::nalgebra::Vector3;
use nucleus_core::{Cloth, ClothId, ClothLists, Collider, Mass, ModelBuilder, Solver, StateView, Surface};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sides = [Vector3::x(), Vector3::z()];
    let sheet = Surface::sheet(Vector3::new(-0.5, 0.5, -0.5), sides, [40, 40]);
    let ball = Surface::sphere(Vector3::zeros(), 0.3, 12);

    let mut builder = ModelBuilder::new();
    let cloth: ClothId = builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), ClothLists::DEFAULT))?;
    builder.collider(Collider { surface: ball })?;

    let mut solver: Solver = Solver::new(builder, 1);
    let mut frame = solver.default_frame();
    frame.cloths[0].thickness = 0.004;
    frame.cloths[0].friction = 0.3;
    frame.colliders[0].thickness = 0.004;
    solver.check_frame(&frame)?;

    for number in 1..=48 {
        let report = solver.step(&frame, &mut ());
        let corner = solver.point(cloth, 0);
        println!("frame {number}: corner at {:.3} m, strain {:.2} %", corner.y, 100.0 * report.max_strain);
    }
    Ok(())
}
