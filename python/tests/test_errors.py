import copy
import os
import pickle

import numpy as np
import pytest

import nucleus


def test_exceptions_are_the_same_after_pickling(folder):
    with pytest.raises(nucleus.SceneError) as refused:
        nucleus.Scene((folder / "drape.ron").read_text().replace("nRigid", "nRigd"), "drape.ron")
    errors = [refused.value, nucleus.RunError("refused", "error: refused"), nucleus.NucleusError("damaged")]
    for error in errors:
        for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
            assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))
    assert refused.value.diagnostics


def test_arguments_of_the_wrong_type_are_refused_with_what_is_accepted(folder):
    with pytest.raises(TypeError, match="`set` takes a dict such as .*, not int"):
        nucleus.run("drape.ron", set=5)
    with pytest.raises(TypeError, match="`vary` takes a dict such as .*, not int"):
        nucleus.wedge("drape.ron", 5, out="w")
    for value in (3, np.float32(3), np.array(3)):
        with pytest.raises(TypeError, match="`x.y` takes a list of values, or a text"):
            nucleus.wedge("drape.ron", {"x.y": value}, out="w")
    for call in (nucleus.Simulation, nucleus.run):
        with pytest.raises(TypeError, match="a scene is a path, a nucleus.Scene or a dict, not int"):
            call(5)
    with pytest.raises(TypeError, match="from its text or a dict, not int"):
        nucleus.Scene(5)
    with pytest.raises(TypeError, match="not int"):
        nucleus.Scene.read(5)
    with pytest.raises(TypeError, match="name of an attribute is a text, not int"):
        nucleus.Scene.read("drape.ron")["cloth1"][5]


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        ({"nodes": 5}, "`nodes` of a scene is a dict of nodes by name, not int"),
        ({"time": 5}, "`time` of a scene is a dict of start, end and fps, not int"),
        ({"checks": "finite"}, "`checks` of a scene is a list of checks, not str"),
        ({"connections": 5}, "`connections` of a scene is a list of pairs of plugs, not int"),
        ({"connections": [5]}, "a connection is a pair of plugs"),
        ({"nodes": {5: {"type": "nucleus"}}}, "the name of a node is a text, not int"),
        ({"nodes": {"n": {"type": "nucleus", 5: 1}}}, "the name of an attribute is a text, not int"),
    ],
)
def test_a_dict_that_is_no_scene_is_refused_with_what_a_scene_has(scene, said):
    with pytest.raises(TypeError, match=said):
        nucleus.Scene.from_dict(scene)


def test_a_scene_that_is_not_text_is_refused(folder):
    (folder / "py.mcap").write_bytes(bytes(range(256)))
    with pytest.raises(ValueError, match="`py.mcap` is not a scene: it is not UTF-8 text. `nucleus.open`") as refused:
        nucleus.Simulation("py.mcap")
    assert not isinstance(refused.value, UnicodeError)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes in folders")
def test_a_pipe_is_no_cache(folder):
    os.mkfifo("pipe.mcap")
    with pytest.raises(OSError, match="`pipe.mcap` is not a regular file"):
        nucleus.open("pipe.mcap")
