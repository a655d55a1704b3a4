import numpy as np
import pytest

import nucleus


def test_attributes_are_read_and_set_and_comments_stay(folder):
    scene = nucleus.Scene.read("drape.ron")
    assert scene["cloth1"].type == "nCloth" and scene.frames == (1, 8)
    scene["cloth1"]["bendResistance"] = 2
    scene["nucleus1"]["resistanceModel"] = "classic"
    scene["nucleus1"]["windDirection"] = np.array([0, 0, 1])
    scene["nucleus1"]["windSpeed"] = nucleus.Raw("keys([(1, 0), (8, 7)])")
    assert scene["cloth1"]["bendResistance"] == 2
    assert scene["nucleus1"]["resistanceModel"] == "classic"
    assert scene["nucleus1"]["windDirection"] == [0, 0, 1]
    assert scene["nucleus1"].at("windSpeed", 8) == 7
    assert "// Half a metre of cloth" in scene.text
    scene["sheet"]["translateY"] = 26
    assert (scene["sheet"]["translateY"], scene["sheet"]["translate"]) == (26, [0, 26, 0])
    assert scene["cloth1"]["friction"] == pytest.approx(0.1)  # Maya's default


def test_a_node_is_a_mapping_of_its_attributes(folder):
    scene = nucleus.Scene.read("drape.ron")
    for name in scene:
        values = dict(scene[name])
        assert list(values) == list(scene[name]) and "bendResistence" not in scene[name]
    values = dict(scene["cloth1"])
    assert (values["thickness"], values["friction"]) == (1, pytest.approx(0.1))
    assert "translateY" in scene["sheet"]


def test_mistakes_are_exceptions_with_place_and_suggestion(folder):
    scene = nucleus.Scene.read("drape.ron")
    before = scene.text
    with pytest.raises(ValueError, match="did you mean `bendResistance`"):
        scene["cloth1"]["bendResistence"] = 2
    with pytest.raises(ValueError, match="cloth1"):
        scene["cloth1"]["thickness"] = -1
    with pytest.raises(ValueError, match="finite"):
        scene["cloth1"]["thickness"] = float("nan")
    with pytest.raises(TypeError, match="not object"):
        scene["cloth1"]["thickness"] = object()
    with pytest.raises(KeyError, match="clth1"):
        scene["clth1"]["thickness"] = 1
    assert scene.text == before
    with pytest.raises(nucleus.SceneError) as refused:
        nucleus.Scene(before.replace("thickness", "thicknes"), "drape.ron")
    (one,) = refused.value.diagnostics
    assert (one.line, one.help) == (7, "did you mean `thickness`?")
    assert "drape.ron:7:" in str(refused.value)


def test_a_scene_from_a_dict_is_the_scene_from_text(folder):
    scene = nucleus.Scene.from_dict({
        "time": {"start": 1, "end": 8, "fps": 24},
        "nodes": {
            "nucleus1": {"type": "nucleus", "spaceScale": 0.01, "subSteps": 2, "resistanceModel": "physical"},
            "sheet": {"type": "polyPlane", "width": 50, "height": 50, "subdivisions": (6, 6), "translate": (0, 25, 0)},
            "cloth1": {"type": "nCloth", "inputMesh": "sheet", "thickness": 1},
            "ball": {"type": "polySphere", "radius": 20},
            "rigid1": {"type": "nRigid", "inputMesh": "ball"},
        },
    })
    ours, theirs = nucleus.Simulation(scene, threads=1), nucleus.Simulation("drape.ron", threads=1)
    for _ in range(3):
        ours.step(), theirs.step()
    assert np.array_equal(ours.positions("cloth1"), theirs.positions("cloth1"))


def test_a_scene_from_a_dict_has_its_connections():
    nodes = {
        "nucleus1": {"type": "nucleus"},
        "sheet": {"type": "polyPlane"},
        "lift": {"type": "transform", "translateY": 0.25},
        "cloth1": {"type": "nCloth", "inputMesh": "sheet"},
    }
    pair = ("lift.translateY", "cloth1.friction")
    scene = nucleus.Scene.from_dict({"nodes": nodes, "connections": [pair]})
    assert 'connections: [("lift.translateY", "cloth1.friction")],' in scene.text
    with pytest.raises(nucleus.SceneError):
        nucleus.Scene.from_dict({"nodes": nodes, "connections": [("lift.nothing", pair[1])]})
