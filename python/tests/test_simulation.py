import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import nucleus


def test_a_step_loop_gives_the_positions_of_the_command(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    assert (simulation.frame, simulation.units) == (1, "cm")
    reports = list(simulation)
    assert simulation.is_done and [report["frame"] for report in reports] == [2, 3, 4, 5, 6, 7, 8]
    cache = nucleus.run("drape.ron").open()
    assert np.array_equal(simulation.positions("cloth1"), cache.positions("cloth1"))
    keys = ["max_strain", "contacts", "kinetic_energy"]
    assert [[one[key] for key in keys] for one in reports] == [[one[key] for key in keys] for one in cache.reports]


def test_checks_are_evaluated_as_the_command_does(folder):
    text = (folder / "drape.ron").read_text().replace("[finite]", "[finite, maxStretch99(0.000001)]")
    scene = nucleus.Scene(text)
    simulation = nucleus.Simulation(scene, threads=1)
    for _ in simulation:
        pass
    run = nucleus.run(scene, record="none")
    assert [check["passed"] for check in simulation.checks] == [True, False]
    assert simulation.checks == run.checks


def test_arrays_are_views_that_stay_as_they_are(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    start = simulation.positions("cloth1")
    again = simulation.positions("cloth1")
    assert (start.shape, start.dtype, start.flags.owndata) == ((49, 3), np.float32, False)
    assert not start.flags.writeable
    before = start.copy()
    simulation.step()
    assert np.array_equal(start, before) and np.array_equal(again, before)
    now = simulation.positions("cloth1")
    assert not np.array_equal(now, before) and not np.shares_memory(now, start)
    # Memory that no array refers to is used again.
    del start, again, now
    address = simulation.positions("cloth1").ctypes.data
    simulation.step()
    assert simulation.positions("cloth1").ctypes.data == address
    # An array outlives its simulation.
    last = simulation.positions("cloth1")
    copy = last.copy()
    del simulation
    assert np.array_equal(last, copy)


def test_a_collider_follows_an_array(folder):
    still, moved = (nucleus.Simulation("drape.ron", threads=1) for _ in range(2))
    start = moved.positions("rigid1").astype(np.float64)
    for step in range(1, 6):
        moved.move_collider("rigid1", start + [0, 2.0 * step, 0])
        moved.step(), still.step()
    assert np.allclose(moved.positions("rigid1"), start + [0, 10, 0], atol=1e-4)
    assert moved.positions("cloth1")[:, 1].max() > still.positions("cloth1")[:, 1].max() + 5
    assert moved.step()["pairs_unresolved"] == 0


def test_arrays_of_the_wrong_shape_or_type_are_refused(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    good = simulation.positions("rigid1").copy()
    with pytest.raises(ValueError, match="382 points, but positions of 3 were given"):
        simulation.move_collider("rigid1", good[:3])
    with pytest.raises(ValueError, match=r"shape \(n, 3\)"):
        simulation.move_collider("rigid1", good[:, :2])
    with pytest.raises(TypeError, match="positions are numbers"):
        simulation.move_collider("rigid1", np.full((382, 3), "x"))
    with pytest.raises(ValueError, match="point 7 of `rigid1` is not finite"):
        bad = good.copy()
        bad[7, 1] = np.nan
        simulation.move_collider("rigid1", bad)
    with pytest.raises(ValueError, match="only colliders"):
        simulation.move_collider("cloth1", good)
    with pytest.raises(KeyError, match="ball"):
        simulation.positions("ball2")
    # Any layout and type of number is taken.
    simulation.move_collider("rigid1", np.asfortranarray(good.astype(np.float32))[::1])
    simulation.step()


def test_a_saved_state_continues_with_the_same_bits(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    for _ in range(3):
        simulation.step()
    state = simulation.save()
    simulation.step()
    expected = simulation.positions("cloth1").copy()
    simulation.restore(state)
    simulation.step()
    assert np.array_equal(simulation.positions("cloth1"), expected)
    with pytest.raises(nucleus.NucleusError, match="cannot restore"):
        simulation.restore(b"nothing")


def test_a_state_is_not_saved_while_a_move_waits(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    start = simulation.positions("rigid1").copy()
    state = simulation.save()
    simulation.move_collider("rigid1", start + [0, 2, 0])
    with pytest.raises(RuntimeError, match="`rigid1` is to move during the next frame"):
        simulation.save()
    simulation.step()
    assert simulation.save() != state
    # A state that is restored has no move that waits.
    simulation.move_collider("rigid1", start)
    simulation.restore(state)
    assert simulation.save() == state


def test_a_collider_is_not_moved_beyond_the_range_of_the_solver(folder):
    simulation = nucleus.Simulation("drape.ron", threads=1)
    far = simulation.positions("rigid1").astype(np.float64)
    far[3, 1] = -1e14  # 1e12 m in centimetres
    simulation.move_collider("rigid1", far)
    far[3, 1] *= 1.01
    with pytest.raises(ValueError, match="point 3 of `rigid1` is too far away: coordinates are at most 1e14 "):
        simulation.move_collider("rigid1", far)


INTERRUPTED = """
import os, signal, threading
import nucleus

signal.signal(signal.SIGINT, signal.default_int_handler)
text = open("drape.ron").read()
simulation = nucleus.Simulation(nucleus.Scene(text.replace("subSteps: 2", "subSteps: 90000")), threads=1)
start, state = simulation.positions("rigid1"), simulation.save()
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    simulation.step()
    print("not interrupted")
except KeyboardInterrupt:
    pass
for refused in (simulation.step, simulation.save, lambda: simulation.move_collider("rigid1", start)):
    try:
        refused()
    except RuntimeError as error:
        print(error)
simulation.restore(state)
print(simulation.save() == state)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_an_interrupted_simulation_is_neither_saved_nor_moved_until_it_is_restored(folder):
    command = [sys.executable, "-c", INTERRUPTED]
    said = subprocess.run(command, check=True, capture_output=True, text=True, timeout=120).stdout
    refusal = "the simulation was interrupted within a frame: restore a saved state, or make a new one"
    assert said.splitlines() == [refusal] * 3 + ["True"]


def test_the_interpreter_is_free_while_a_frame_is_solved(folder):
    text = (folder / "drape.ron").read_text().replace("subSteps: 2", "subSteps: 3000")
    simulation = nucleus.Simulation(nucleus.Scene(text), threads=1)
    counted, solving = [0], threading.Event()

    def step():
        simulation.step()
        solving.set()

    worker = threading.Thread(target=step)
    worker.start()
    while not solving.is_set():
        counted[0] += 1
    worker.join()
    assert counted[0] > 1000
