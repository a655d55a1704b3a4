import pytest

SCENE = """Scene(
    time: (start: 1, end: 8, fps: 24),
    nodes: {
        // Half a metre of cloth over a ball.
        "nucleus1": nucleus(spaceScale: 0.01, subSteps: 2),
        "sheet": polyPlane(width: 50, height: 50, subdivisions: (6, 6), translate: (0, 25, 0)),
        "cloth1": nCloth(inputMesh: "sheet", thickness: 1),
        "ball": polySphere(radius: 20),
        "rigid1": nRigid(inputMesh: "ball"),
    },
    checks: [finite],
)
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a small scene, `drape.ron`."""
    (tmp_path / "drape.ron").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    return tmp_path
