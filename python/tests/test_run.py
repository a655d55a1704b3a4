import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import nucleus
from nucleus._run import problems_of


def test_a_run_has_the_bytes_of_the_command(folder):
    seen = []
    run = nucleus.run("drape.ron", frames=5, set={"cloth1.bendResistance": 2}, out="a.mcap", on_frame=seen.append)
    assert run.ok and run.checks[0]["passed"] and [one["frame"] for one in run.frames] == [2, 3, 4, 5]
    assert seen == run.frames
    command = [sys.executable, "-m", "nucleus", "run", "drape.ron", "--frames", "5", "-o", "b.mcap"]
    subprocess.run([*command, "--set", "cloth1.bendResistance=2"], check=True)
    assert (folder / "a.mcap").read_bytes() == (folder / "b.mcap").read_bytes()


def test_a_cache_gives_positions_in_scene_units(folder):
    cache = nucleus.run("drape.ron", frames=5, velocities=True, record="strain").open()
    assert (cache.units, cache.frames, cache.fps) == ("cm", [1, 2, 3, 4, 5], 24)
    assert cache.objects == {"cloth1": {"kind": "cloth", "points": 49}, "rigid1": {"kind": "collider", "points": 382}}
    start, end = cache.positions("cloth1", frame=1), cache.positions("cloth1")
    assert (start.shape, start.dtype) == ((49, 3), np.float32)
    assert np.allclose(start[:, 1], 25) and end[:, 1].max() < 25
    # A free fall of four frames: g t^2 / 2 in centimetres, before the ball is reached.
    assert cache.velocities("cloth1", 2)[:, 1].mean() == pytest.approx(-980 / 24, rel=0.05)
    assert cache.strain("cloth1").shape == (49,)
    counts, corners = cache.faces("cloth1")
    assert (len(counts), corners.max()) == (36, 48)
    assert [report["frame"] for report in cache.reports] == [2, 3, 4, 5]
    with pytest.raises(KeyError, match="it has 1 to 5"):
        cache.positions("cloth1", frame=9)
    with pytest.raises(KeyError, match="`cloth1`, `rigid1`"):
        cache.positions("cloth2")
    with pytest.raises(OSError, match="none.mcap"):
        nucleus.open("none.mcap")


def test_a_cache_gives_the_number_and_age_of_particles_that_are_born(folder):
    nodes = """"n": nucleus(gravity: 0), "p": nParticle(selfCollide: false), "e": pointEmitter(target: "p", rate: 48)"""
    (folder / "drops.ron").write_text(f"Scene(time: (start: 1, end: 5, fps: 24), nodes: {{{nodes}}})")
    cache = nucleus.run("drops.ron").open()
    particles = cache.particles("p")
    assert len(particles) == len(cache.positions("p")) == 8
    assert list(particles["id"]) == list(range(8)) and np.all(particles["mass"] > 0)
    assert np.allclose(particles["age"], np.arange(7, -1, -1) / 48, atol=1 / 48)
    assert len(cache.particles("p", frame=1)) == 0


def test_mistakes_are_exceptions(folder):
    with pytest.raises(nucleus.RunError, match="did you mean `bendResistance`"):
        nucleus.run("drape.ron", set={"cloth1.bendResistence": 2})
    text = (folder / "drape.ron").read_text()
    (folder / "bad.ron").write_text(text.replace("nRigid", "nRigd"))
    with pytest.raises(nucleus.SceneError, match="bad.ron:9:"):
        nucleus.run("bad.ron")
    nucleus.run("drape.ron", frames=2)
    with pytest.raises(nucleus.RunError, match="exists"):
        nucleus.run("drape.ron", frames=2)
    (folder / "strict.ron").write_text(text.replace("[finite]", "[atRestBy(frame: 3, speed: 0)]"))
    run = nucleus.run("strict.ron", frames=4)
    assert not run.ok and "atRestBy" in run.problems[0]


def test_a_scene_in_memory_is_run_and_leaves_no_file(folder):
    scene = nucleus.Scene.read("drape.ron")
    scene["cloth1"]["friction"] = 0.7
    one = nucleus.run(scene, frames=3, out="one.mcap")
    assert "friction: 0.7" in one.open().scene
    nucleus.run(scene, frames=3, out="two.mcap")
    assert (folder / "one.mcap").read_bytes() == (folder / "two.mcap").read_bytes()
    assert sorted(path.name for path in folder.glob("*.ron")) == ["drape.ron"]


def test_a_failed_check_without_a_frame_has_the_words_of_the_command():
    check = {"check": "atRestBy(frame: 9)", "passed": False, "figure": None, "frame": None}
    assert problems_of({"ending": "done", "checks": [check]}) == [
        "check atRestBy(frame: 9) failed, no frame was evaluated"
    ]


def test_threads_run_the_same_scene_in_memory_at_once(folder):
    text = (folder / "drape.ron").read_text() + "// in memory\n"

    def run(number):
        # The longer runs still read their scene when the first one has ended.
        return nucleus.run(nucleus.Scene(text), frames=2 + number, out=f"{number}.mcap", threads=1)

    with ThreadPoolExecutor(6) as pool:
        runs = list(pool.map(run, range(6)))
    assert all(one.ok and one.open().scene == text for one in runs)
    assert sorted(path.name for path in folder.glob("*.ron")) == ["drape.ron"]


def test_a_scene_in_memory_does_not_remove_the_file_of_a_wedge(folder):
    scene = nucleus.Scene.read("drape.ron")
    scene["cloth1"]["friction"] = 0.7
    nucleus.wedge(scene, {"cloth1.bendResistance": [1]}, out="w", frames=2)
    kept = sorted(folder.glob("*.ron"))
    assert len(kept) == 2
    nucleus.run(scene, frames=2)
    assert sorted(folder.glob("*.ron")) == kept
    assert len(nucleus.wedge(out="w", resume=True)) == 1


def test_a_scene_in_memory_that_cannot_be_written_is_refused_with_the_folder_and_the_way_out(folder):
    scene = nucleus.Scene((folder / "drape.ron").read_text(), "none/scene.ron")
    with pytest.raises(FileNotFoundError, match="folder `none`.* relative to its file.*nucleus.Scene"):
        nucleus.run(scene)


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_an_interrupt_closes_the_cache_and_ends_a_step_loop(folder):
    text = (folder / "drape.ron").read_text().replace("end: 8", "end: 1000000")
    (folder / "long.ron").write_text(text)
    loop = "import nucleus\nprint('go', flush=True)\n"
    programs = {
        "run": loop + "nucleus.run('long.ron', record='frames')",
        "step": loop + "for _ in nucleus.Simulation('long.ron', threads=1): pass",
    }
    # A job in the background ignores the signal, and its children do.
    listen = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    for name, program in programs.items():
        child = subprocess.Popen(
            [sys.executable, "-c", listen + program], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        child.stdout.readline()
        begin = time.monotonic()
        while name == "run" and not (folder / "long.mcap.part").exists():
            assert time.monotonic() - begin < 60
            time.sleep(0.01)
        time.sleep(1)
        child.send_signal(signal.SIGINT)
        _, said = child.communicate(timeout=60)
        assert b"KeyboardInterrupt" in said, said
    assert nucleus.open("long.mcap").is_intact


def test_a_wedge_is_a_list_of_results(folder):
    vary = {"cloth1.bendResistance": [0.1, 10], "nucleus1.windSpeed": "0..5/2"}
    runs = nucleus.wedge("drape.ron", vary, out="w", frames=3, jobs=2)
    assert [run.outcome for run in runs] == ["success"] * 4
    assert runs[3].values == {"cloth1.bendResistance": "10", "nucleus1.windSpeed": "5"}
    by_hand = nucleus.run("drape.ron", frames=3, set={"cloth1.bendResistance": 10, "nucleus1.windSpeed": 5})
    assert np.array_equal(runs[3].open().positions("cloth1"), by_hand.open().positions("cloth1"))
    with pytest.raises(nucleus.RunError, match="holds a plan already"):
        nucleus.wedge("drape.ron", vary, out="w")
    assert len(nucleus.wedge(out="w", resume=True)) == 4


def test_a_wedge_with_a_mistake_is_refused_before_anything_is_written(folder):
    with pytest.raises(nucleus.RunError, match="did you mean `bendResistance`"):
        nucleus.wedge("drape.ron", {"cloth1.bendResistence": [1]}, out="w")
    with pytest.raises(nucleus.RunError, match="thickness"):
        nucleus.wedge("drape.ron", {"cloth1.thickness": [1, -1]}, out="w")
    assert not (folder / "w").exists()
