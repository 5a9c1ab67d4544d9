"""The wheel holds all that the package needs, and works without a clone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import venv

import pytest

from support.places import ROOT

pytestmark = pytest.mark.slow
CLEAN = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
"""Variables without a place in which the package would be found instead."""
PRESS = """
import contactsim as cs
heights = cs.Cylinder(radius=1e6, length=4e4).heights(256)
result = cs.press(heights, spacing=4e4 / 256, contact_modulus=1.0, mean_pressure=1e-3)
assert result.status is cs.Status.CONVERGED
print(cs.__file__)
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The folder of programs of an environment with the wheel; what the wheel needs comes from this environment."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    shutil.copytree(ROOT / "src", source / "src", ignore=shutil.ignore_patterns("*.egg-info", "__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    build = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*build, "--wheel-dir", folder, source], env=CLEAN, check=True)
    (wheel,) = folder.glob("*.whl")
    venv.create(folder / "env", with_pip=False)
    target = next((folder / "env/lib").glob("python*/site-packages"))
    install = [sys.executable, "-m", "pip", "--python", folder / "env/bin/python", "install", "--quiet", "--no-deps"]
    subprocess.run([*install, wheel], env=CLEAN, check=True)
    (target / "others.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    return folder / "env/bin"


def test_a_wheel_presses_and_runs_a_scene_outside_of_a_clone(installed, tmp_path):
    def call(*command):
        done = subprocess.run(command, cwd=tmp_path, env=CLEAN, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert call(installed / "python", "-P", "-c", PRESS).startswith(str(installed.parent))
    call(installed / "contactsim", "new", "rough_line")
    assert "written to rough_line.nc" in call(installed / "contactsim", "run", "rough_line.yaml")
    assert (tmp_path / "rough_line.nc").stat().st_size > 1000
    assert "contactsim" in call(installed / "contactsim", "--version")


def test_a_wheel_holds_the_files_that_are_no_code(installed):
    (package,) = installed.parent.glob("lib/python*/site-packages/contactsim")
    source = installed.parents[1] / "source/src/contactsim"
    held = {str(file.relative_to(package)) for file in package.rglob("*") if file.is_file()}
    data = {str(file.relative_to(source)) for file in source.rglob("*.*") if file.suffix != ".py"}
    assert data <= held
    assert {"variables.csv", "publish/page/report.js", "templates/rough_line.yaml"} <= data
