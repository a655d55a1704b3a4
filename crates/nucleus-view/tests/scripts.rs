//! Modules of the player that need no browser, in Node. Without Node these tests print a note and pass.

use std::path::Path;
use std::process::Command;

/// Runs a script beside the modules of the player; it fails where a condition does not hold.
fn run(script: &str) {
    let folder = tempfile::tempdir().unwrap();
    let modules = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/player");
    for entry in std::fs::read_dir(modules).unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).unwrap();
    }
    std::fs::write(folder.path().join("package.json"), r#"{"type":"module"}"#).unwrap();
    let test = folder.path().join("test.js");
    std::fs::write(&test, format!("import assert from \"node:assert/strict\";\n{script}")).unwrap();
    match Command::new("node").arg(&test).output() {
        Ok(output) => assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr)),
        Err(error) => eprintln!("no Node here ({error}): the modules of the player were not tested"),
    }
}

#[test]
fn the_first_view_leaves_far_and_large_colliders_out_and_frame_all_does_not() {
    run(r#"
        import { boxOfAll, boxToFrame } from "./framing.js";
        const cube = (kind, at, half) => ({ kind, points: Float32Array.of(at - half, -half, -half, at + half, half, half) });
        const objects = [cube("cloth", 0, 1), cube("collider", 9, 1), cube("collider", 0, 30)];
        assert.deepEqual(boxToFrame(objects), { low: [-1, -1, -1], high: [1, 1, 1] });
        assert.deepEqual(boxOfAll(objects.slice(0, 2)), { low: [-1, -1, -1], high: [10, 1, 1] });
        assert.deepEqual(boxOfAll(objects), { low: [-30, -30, -30], high: [30, 30, 30] });
        assert.equal(boxOfAll([]), null);
    "#);
}

#[test]
fn a_click_on_the_surface_of_a_liquid_picks_its_nearest_particle_and_not_the_cloth_behind() {
    run(r#"
        import { perspective, view } from "./camera.js";
        import { Mesh } from "./mesh.js";
        import { pointAt } from "./pick.js";
        const square = (name, kind, z, more = {}) => {
            const rest = Float32Array.of(-1, -1, z, 1, -1, z, 1, 1, z, -1, 1, z);
            const mesh = new Mesh({ kind, points: 4, starts: Uint32Array.of(0, 4), corners: Uint32Array.of(0, 1, 2, 3), rest });
            mesh.update(rest.slice());
            return { name, mesh, isShown: true, ...more };
        };
        const camera = {
            matrices: (aspect) => ({ view: view([0, 0, 5], [1, 0, 0], [0, 1, 0], [0, 0, 1]), projection: perspective(0.5, aspect, 0.1, 99) }),
        };
        const at = [55, 45]; // right of the centre and above it
        const pick = (objects) => pointAt({ objects, aspect: 1, canvas: { clientWidth: 100, clientHeight: 100 } }, camera, at);
        const sheet = square("sheet", "cloth", -2);
        // The surface has four points, the liquid six particles; the last is nearest to the right upper corner.
        const recorded = Float32Array.of(-1, -1, 0, 1, -1, 0, -1, 1, 0, 0, 0, 0, 0.2, 0.2, 0, 0.9, 0.9, 0);
        const water = square("water", "surface", 0, { recorded });
        assert.deepEqual(pick([sheet]), { object: "sheet", point: 2 });
        for (const objects of [[sheet, water], [water, sheet]]) {
            assert.deepEqual(pick(objects), { object: "water", point: 5 });
        }
        water.isShown = false;
        assert.deepEqual(pick([water, sheet]), { object: "sheet", point: 2 });
    "#);
}

#[test]
fn the_scale_of_the_speed_fits_the_run() {
    run(r#"
        import { fittedSpeed } from "./speed.js";
        const cloth = { kind: "cloth", points: 1 };
        // At 24 frames a second, `perFrame` of 1 is 24 units per second; the other object does not move.
        const cache = (perFrame, frames) => ({
            objects: [{ topology: cloth }, { topology: cloth }],
            frames: Array(frames),
            state: async (index) => ({
                index, time: index / 24, meshes: [{ kind: "cloth", number: 0 }, { kind: "cloth", number: 0 }],
                positions: [Float32Array.of(perFrame * index, 0, 0), Float32Array.of(3, 3, 3)], velocities: [], numbers: [],
            }),
        });
        assert.equal(await fittedSpeed(cache(1, 30)), 50);
        assert.equal(await fittedSpeed(cache(100, 30)), 5000);
        assert.ok(Math.abs(await fittedSpeed(cache(0.001, 30)) / 0.05 - 1) < 1e-9);
        assert.equal(await fittedSpeed(cache(0, 30)), 0);
        assert.equal(await fittedSpeed(cache(1, 1)), 0);
    "#);
}
