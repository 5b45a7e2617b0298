#!/usr/bin/python3
# Tests of the files that cmake --install installs: program, Python package, manual page, shell completion, and a
# library to which another project links.
import os
import pathlib
import shutil
import subprocess

import h5py
import numpy as np

from harness import PROGRAM, SOURCE, check, close, main


def _done(*words, **more):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    check(result.returncode == 0, words, result.stdout, result.stderr)
    return result.stdout


def _installed():
    place = pathlib.Path("place").resolve()
    _done("cmake", "--install", PROGRAM.parents[1], "--prefix", place)
    return place, os.environ | {"PATH": f"{place / 'bin'}:{os.environ['PATH']}", "TANKTREAD": ""}


def the_installed_program_and_package_run_and_draw_a_scene():
    place, environment = _installed()
    pathlib.Path("mine.yaml").write_text(_done("tanktread", "--new", "capsule", env=environment))
    _done("tanktread", "mine.yaml", "--set", "Surface/elements per side=3", "--set", "Time/final time=2 ms", "--output", "mine", "--quiet", env=environment)
    _done("tanktread-report", "mine", env=environment)
    pathlib.Path("study.yaml").write_text("deck: mine.yaml\nset: {Surface/elements per side: 3, Time/final time: 1 ms}\n"
                                          "grid: {Membrane/shear modulus: [0.5 mN/m, 1 mN/m]}\nrecord: [taylor_inertia]\n")
    _done("tanktread-sweep", "study.yaml", env=environment)
    check(pathlib.Path("mine/report.html").exists() and pathlib.Path("results/study/table.csv").read_text().count(",done,") == 2, "report or table")
    check("deformation" in _done("tanktread-figure", "--list", env=environment), "the figures")
    there = _done("/usr/bin/python3", "-c", "import tanktread; print(tanktread.PROGRAM)", cwd="/",
                  env=environment | {"PYTHONPATH": str(place / "lib/python3/dist-packages")})
    check(there.strip() == str(place / "bin/tanktread"), "the program that the package runs is", there)
    page = (place / "share/man/man1/tanktread.1").read_text()
    check(".SH NAME" in page and "\\-\\-resume" in page, page[:500])


def options_keys_and_words_are_completed():
    place, environment = _installed()
    script = """source %s; complete() { :; }; COMP_WORDS=(%s); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMP_LINE=%s; COMP_POINT=${#COMP_LINE}
        compopt() { :; }; _tanktread; printf '%%s\\n' "${COMPREPLY[@]}" """
    completion = place / "share/bash-completion/completions/tanktread"

    def completed(line):
        words = " ".join(f"'{word}'" for word in line.split(" "))
        return _done("bash", "-c", script % (completion, words, f"'{line}'"), env=environment).split("\n")

    check("--resume" in completed("tanktread --res"), completed("tanktread --res"))
    check("Membrane/law=neo-Hookean" in completed("tanktread --set Membrane/l"), completed("tanktread --set Membrane/l"))
    check("red-cell" in completed("tanktread --new r"), completed("tanktread --new r"))


def _package(place):
    _done("cmake", "-G", "Ninja", "-S", SOURCE / "tests/package", "-B", "build", f"-DCMAKE_PREFIX_PATH={place}")
    _done("cmake", "--build", "build", "--parallel", "2")


def another_project_links_the_library_and_adds_parts():
    place, _ = _installed()
    _package(place)
    check(abs(float(_done("build/sphere")) - 1) < 1e-4, "volume of a sphere")
    for name, *part in PARTS:
        _adds_a_part(pathlib.Path("build", name).resolve(), name, *part)
    for setting, why in ("Domain/side lengths=[8, 8, 8]", "not the same in all cells"), ("Particle/drift=held", "never reach its balance"):
        trap = subprocess.run([pathlib.Path("build/load"), "load.yaml", "--set", setting, "--output", "refused", "--quiet"], capture_output=True, text=True)
        check(trap.returncode == 2 and why in trap.stderr, setting, trap.stderr)


def _deck(flow, membrane, time, more=""):
    return f"""Tanktread:
  Flow: {{ {flow} }}
  Particle: {{ center: [0.3, 0, 0] }}
  Membrane: {{ shear modulus: 1{membrane} }}
  Surface: {{ elements per side: 3 }}
  Time: {{ {time}, final time: 0.4 }}
  Output: {{ interval: 0.1{more} }}
"""


def _draws_to_its_center(of):
    # modulus of the trap x area x distance
    close(of["trap_force"][0], 0.2 * 4 * np.pi * 0.3, 1e-3, "force of the trap")
    check((np.diff(of["trap_potential"]) < 0).all() and of["centroid_x1"][-1] < 0.3, of["trap_potential"], of["centroid_x1"])


def _follows_the_area(of):
    time, q = of["time"], of["reflex"]
    rate = (of["area"] / of["area"][0] - 1 - q) / 0.5
    close(q[-1], np.sum(np.diff(time) * (rate[1:] + rate[:-1]) / 2), 0.02 * q[-1], "integral of the rate")
    check(q[0] == 0 and q[-1] > 1e-3, q)


def _goes_round(of):
    close(of["velocity_x1"][0], 3 / np.hypot(3, 0.3) ** 3, 1e-3, "velocity in the flow of the rotlet")
    check(of["velocity_x3"][0] < -0.01, of["velocity_x3"])


def _is_the_upper_of_a_mirrored_pair(of):
    pathlib.Path("pair.yaml").write_text("""Tanktread:
  Flow: { type: linear, gradient: [1, 0, 0, 0, -1, 0, 0, 0, 0] }
  Particles:
    defaults: { viscosity ratio: 2, Membrane: { shear modulus: 1 }, Surface: { elements per side: 3 } }
    upper: { center: [0.3, 0, 1.2] }
    lower: { center: [0.3, 0, -1.2] }
  Time: { tolerance: 1e-4, final time: 0.4 }
  Output: { interval: 0.1 }
""")
    _done(PROGRAM, "pair.yaml", "--output", "pair", "--quiet")
    with h5py.File("pair/run.h5") as file:
        pair = {f"upper/{name}": data[:] for name, data in file["series/upper"].items()}
    of["centroid_x3"] -= 0.1  # subtracts the height of the plane
    for name in ("centroid_x1", "centroid_x3", "taylor_inertia", "energy"):
        # Quadrature/tolerance is 1e-4, and the far nodes of the two problems are the same, so that only rules for close panels differ.
        close(of[name][-1], pair[f"upper/{name}"][-1], 1e-5 * pair[f"upper/{name}"][-1], name)
    check(of["centroid_x3"][-1] > 1.2003, "the plane has no effect", of["centroid_x3"])


def _measures_the_extent(of):
    close(of["stretch"][0] / of["length_x1"][0], 1, 0.3, "extent of the control net")
    check((np.diff(of["stretch"]) > 0).all() and np.allclose(of["fastest_way"], of["fastest"] * of["time"]), of["stretch"], of["fastest_way"])


def _tension(deck, *settings, ranks=1):
    launcher = ["mpirun", "-n", ranks] if ranks > 1 else []
    pathlib.Path("tether.yaml").write_text(deck)
    shutil.rmtree("tether", ignore_errors=True)
    _done(*launcher, "build/equation", "tether.yaml", "--output", "tether", "--quiet", *(word for one in settings for word in ("--set", one)))
    return _series("tether")


def _pulls_two_spheres(of):
    # (1 - A) s 6 pi/(2 (x11 - x12)) of two spheres at the distance s in the unit extension (Jeffrey & Onishi 1984; multipole solution)
    length = 1e-12  # round-off of a length of 1
    close(of["tension"][0], 46.8820687, 1e-4 * 46.9, "tension")
    check(abs(of["tether_length"] - of["tether_length"][0]).max() < length, "length", of["tether_length"])
    near = _tension(SPHERES.replace("1.5, 0, 0", "1.05, 0, 0"), "Time/final time=0.05")
    close(near["tension"][0], 39.2582369, 1e-4 * 39.3, "tension at s = 2.1")
    one, two = (_tension(SPHERES, "Solvers/tolerance=1e-12", "Time/final time=0.1", ranks=ranks) for ranks in (1, 2))
    check(abs(two["tension"] / one["tension"] - 1).max() < 1e-10, "tension on two ranks", two["tension"], one["tension"])
    dual = _tension(SPHERES, "Solvers/rigid bodies=second kind", "Time/final time=0.05")  # one body equation for the other
    close(dual["tension"][0], 46.8820687, 1e-3 * 46.9, "tension with densities as unknowns")
    drawn = {scheme: _tension(CAPSULES, f"Time/scheme={scheme}") for scheme in ("bs3", "tr-bdf2")}
    for scheme, series in drawn.items():
        check(abs(series["tether_length"] - series["tether_length"][0]).max() < length, scheme, series["tether_length"])
    close(drawn["tr-bdf2"]["tension"][-1] / drawn["bs3"]["tension"][-1], 1, 1e-3, "tension between capsules by two schemes")


SPHERES = """Tanktread:
  Flow: { type: linear, gradient: [1, 0, 0, 0, -0.5, 0, 0, 0, -0.5] }
  Particles:
    defaults: { motion: free, Surface: { elements per side: 6 } }
    left: { center: [-1.5, 0, 0] }
    right: { center: [1.5, 0, 0] }
  Equations: { tether: { from: left, to: right } }
  Quadrature: { tolerance: 1e-6 }
  Time: { tolerance: 1e-4, final time: 0.4 }
  Output: { interval: 0.1 }
"""
CAPSULES = SPHERES.replace("motion: free", "viscosity ratio: 2, Membrane: { shear modulus: 1, bending number: 0.02 }")
SHEAR = "type: simple shear"
PARTS = [
    ("load", _deck("type: quiescent", ", loads: { trap: { stiffness: 0.2 } }", "scheme: tr-bdf2"), "Membrane/loads/trap/stiffness=3", _draws_to_its_center),
    ("field", _deck("type: uniaxial extension", "", "scheme: bdf3") + "  Interface: { fields: { reflex: { response time: 0.5, tension: 2 } } }\n",
     "Interface/fields/reflex/tension=3", _follows_the_area),
    ("flow", _deck("type: rotlet, rotlet: { strength: [0, 1, 0] }", "", "tolerance: 1e-4"), "Flow/rotlet/strength=[0, 2, 0]", _goes_round),
    ("medium", _deck("type: linear, gradient: [1, 0, 0, 0, -1, 0, 0, 0, 0]", "", "tolerance: 1e-4").replace("[0.3, 0, 0]", "[0.3, 0, 1.3], viscosity ratio: 2")
     + "  Domain: { kind: slip plane, slip plane: { height: 0.1 } }\n", "Domain/slip plane/height=0", _is_the_upper_of_a_mirrored_pair),
    ("series", _deck(SHEAR, "", "tolerance: 1e-4", ", series: { stretch: { direction: [1, 0, 1] }, fastest: {} }"), "Output/series/stretch/direction=[1, 0, 0]",
     _measures_the_extent),
    ("equation", SPHERES, "Equations/tether/to=left", _pulls_two_spheres),
]


def _series(results):
    series = {}
    with h5py.File(pathlib.Path(results, "run.h5")) as file:
        file["series"].visititems(lambda name, data: series.update({name: data[:]}) if isinstance(data, h5py.Dataset) else None)
    return series


def _adds_a_part(program, name, deck, setting, judge):
    """Runs a deck with a key of a user-defined part, once from start to end and once with an interruption. Checks that
    both runs are bitwise equal."""
    path = pathlib.Path(f"{name}.yaml")
    path.write_text(deck)
    key = setting.split("=")[0].rsplit("/", 1)[-1]
    for manual in ("--schema", "--reference"):
        check(f"`{key}`" in _done(program, manual) or f'"{key}":' in _done(program, manual), name, manual, key)
    refused = subprocess.run([PROGRAM, path, "--check"], capture_output=True, text=True)
    check(refused.returncode == 2, name, "is known to the program without the part", refused.stderr)
    _done(program, path, "--output", f"{name}_whole", "--quiet")
    _done(program, path, "--output", f"{name}_parts", "--quiet", "--set", "Time/final time=0.2")
    other = subprocess.run([program, "--resume", f"{name}_parts", "--quiet", "--set", setting], capture_output=True, text=True)
    check(other.returncode == 2 and "cannot change" in other.stderr, name, setting, other.stderr)
    _done(program, "--resume", f"{name}_parts", "--quiet", "--set", "Time/final time=0.4")
    whole, parts = _series(f"{name}_whole"), _series(f"{name}_parts")
    check(whole.keys() == parts.keys(), whole.keys(), parts.keys())
    for column, values in whole.items():
        check(column == "wall_seconds" or values.tobytes() == parts[column].tobytes(), name, column, values, parts[column])
    judge(whole)


def without_the_right_to_install_the_command_for_the_administrator_is_printed():
    tools = pathlib.Path("tools")
    tools.mkdir()
    for name, script in {"id": "echo 1000", "dpkg-query": "exit 1", "apt-get": "exit 9", "sudo": "exit 1"}.items():
        (tools / name).write_text(f"#!/bin/sh\n{script}\n")
        (tools / name).chmod(0o755)
    environment = {**os.environ, "PATH": f"{tools.resolve()}:{os.environ['PATH']}"}
    done = subprocess.run([SOURCE / "app/install", "package"], env=environment, capture_output=True, text=True)
    check(done.returncode == 1 and "\n  apt-get install --no-install-recommends file dpkg-dev\n" in done.stderr, done)


main()
