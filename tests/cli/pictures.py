#!/usr/bin/python3
# The scripts of postproc/ draw what a run wrote, and say in one sentence when they cannot.
import pathlib
import subprocess

from harness import SOURCE, check, deck, main, run

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: sphere }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 3 }
  Time: { final time: 0.2 }
  Output: { interval: 0.1 }
"""


def _script(name, *arguments, code=0):
    """Runs a script of postproc/ and returns what it says."""
    result = subprocess.run([SOURCE / "postproc" / name, *arguments], capture_output=True, text=True)
    check(result.returncode == code and "Traceback" not in result.stderr, name, result.stdout, result.stderr)
    return result.stdout + result.stderr


def a_run_is_drawn():
    deck(DECK)
    run("deck.yaml", "--output", "results", "--quiet")
    pathlib.Path("curve.csv").write_text("t,taylor_inertia\n" + "".join(f"{0.05 * k},{0.05 * k}\n" for k in range(5)))
    words = {"convergence.py": ["--curve", "curve.csv"]}
    for name in "deformation.py", "shape.py", "meshes.py", "refinement.py", "convergence.py":
        _script(name, "results", *words.get(name, []), "-o", f"{name}.png")
        with open(f"{name}.png", "rb") as file:
            check(file.read(8) == b"\x89PNG\r\n\x1a\n", f"{name}.png is no picture")
    _script("animation.py", "results", "-o", "animation.gif")
    with open("animation.gif", "rb") as file:
        check(file.read(6) == b"GIF89a", "animation.gif is no animation")
    check("taylor_inertia" in _script("read.py", "results"), "read.py does not list the series")
    said = _script("shape.py", "results", "--field", "colour", code=1)
    check("colour" in said and "load" in said, said)


def a_rigid_particle_is_drawn_and_what_it_does_not_have_is_named():
    deck(DECK.replace("sphere }", "spheroid, semi-axes: [1.0, 1.0, 0.5], motion: free }").replace("  Membrane: { law: neo-Hookean, capillary number: 0.3 }\n", ""))
    run("deck.yaml", "--output", "rigid", "--quiet")
    _script("shape.py", "rigid")
    for name in "deformation.py", "animation.py", "refinement.py":
        said = _script(name, "rigid", code=1)
        check("no series taylor_inertia" in said and said.count("\n") == 1, said)


def help_is_there_and_absent_results_are_named():
    for name in "deformation.py", "shape.py", "read.py", "animation.py":
        check("usage" in _script(name, "--help"), name)
        said = _script(name, "nowhere", code=1)
        check("nowhere" in said and said.count("\n") == 1, said)


main()
