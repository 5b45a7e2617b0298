#!/usr/bin/python3
"""Wrinkles of a membrane at low capillary number: without bending stiffness their wavelength is set by the mesh, with
bending stiffness it is not.

    tests/benchmark/wrinkles.py  # n = 6, 9, 12: minutes
    tests/benchmark/wrinkles.py --meshes 6 9 12 18 --modulus 0.002

A neo-Hookean capsule in shear at Ca = 0.1 is compressed around its waist. Its mesh is not aligned with the symmetry
planes of the flow, so that the symmetry excludes no wave. The load is expanded in spherical harmonics on the unstressed
sphere. Degrees of 9 and more count as waves, because the flow does not force them. Without bending stiffness, shorter
waves always grow faster. The dominant wave is then the shortest one that the mesh resolves, about two elements long.
The bending moduli E_b are divided by R^2 G_s (R: radius, G_s: shear modulus).
"""

from package import SHEAR, SIDE, answer, command_line, expect, footer, interpolation, numpy, plt, studies, style
import waves

QUIET = 1e-3  # if the waves have less than this share of the load's power, the membrane counts as free of waves


def draw_row(study, axes, modulus, parsed):
    """Draws the spectra, D against time, and the wavelengths for one modulus, and returns the rows of the table. The
    spectra and the mean and range of D are taken over the last two time units."""
    left, middle, right = axes
    rows, lengths = [], []
    sizes = (4 * numpy.pi / (6 * numpy.square(parsed.meshes))) ** 0.5  # mean sizes of elements on the unit sphere
    for n, size, color in zip(parsed.meshes, sizes, style.RUNS):
        one = study.run(SHEAR, {SIDE: n, "Membrane/capillary number": parsed.ca, "Time/final time": parsed.time,
                                "Membrane/bending modulus": modulus / parsed.ca, "Output/interval": 0.5,
                                "Time/tolerance": 3e-4, "Particle/orientation": "[20.0, 35.0, 50.0]"})
        if not one.done:
            print(f"n = {n}: {one.message}")
            continue
        powers, wavelengths = zip(*(waves.spectrum(shot) for shot in one.run.snapshots()
                                    if shot.time >= parsed.time - 2))
        power = sum(each / each.sum() for each in powers) / len(powers)
        # degree of the wave: the degree above SMOOTH with the largest power. It is odd, because the load of a
        # point-symmetric capsule is an odd function on the sphere
        wave = waves.SMOOTH + 1 + int(power[waves.SMOOTH + 1:].argmax())
        short, length = waves.share_of_waves(power), wavelengths[0][wave - 1]
        time, d = one.series["time"], one.series["taylor_inertia"]
        waved, late = short > QUIET, time >= parsed.time - 2
        mean, reach = interpolation.mean(time[late], d[late]), numpy.ptp(d[late])
        rows.append((modulus, n, size, *((wave, length) if waved else ("", "")), short, mean, reach, one.seconds))
        words = f"wave of degree {wave}, {length:.3f} R = {length / size:.2f} elements" if waved else "no waves"
        print(f"E_b = {modulus:g} R^2 G_s, n = {n}: {words}; share beyond degree {waves.SMOOTH} {short:.1e}; "
              f"D = {mean:.5f}, range {reach:.1e}; {one.seconds:.0f} s", flush=True)
        left.semilogy(range(1, len(power), 2), power[1::2], "-", color=color, label=f"n = {n}")
        middle.plot(time, d, color=color)
        if waved:
            lengths.append((1 / size, length))
            left.plot(wave, power[wave], "o", color=color, ms=5)
    expect(rows, f"no run with the modulus {modulus:g} came to its end")
    left.set(title="no bending" if modulus == 0 else f"E_b = {modulus:g} R² G_s", xlabel="degree",
             ylabel="power of the load", ylim=(1e-9, 2))
    middle.set(xlabel="time", ylabel="Taylor parameter D", ylim=(0.9 * rows[-1][6], 1.1 * rows[-1][6]))
    right.plot(*numpy.reshape(lengths, (-1, 2)).T, "o-", color=style.RUNS[0], label="waves" if lengths else "no waves")
    right.plot(1 / sizes, 2.25 * sizes, label="2.25 elements", **style.GUIDE)
    right.set(xlabel="elements per radius", ylabel="wavelength / R", ylim=(0, 0.9))
    for axis in left, right:
        axis.legend(loc="best")
    return rows


def main():
    parser = command_line(__doc__)
    parser.add_argument("--meshes", nargs="+", type=int, default=[6, 9, 12], metavar="N",
                        help="elements per side of the cube (default: 6 9 12)")
    parser.add_argument("--modulus", nargs="+", type=float, default=[0.0, 0.0005, 0.005],
                        help="bending moduli divided by R^2 G_s (default: 0, 0.0005, 0.005)")
    parser.add_argument("--ca", type=float, default=0.1, help="capillary number (default: %(default)s)")
    parser.add_argument("--time", type=float, default=5.0, help="final time of the runs (default: %(default)s)")
    studies.arguments(parser, "results/wrinkles")
    parsed = parser.parse_args()
    study, count = studies.study(parsed), len(parsed.modulus)
    figure, grid = plt.subplots(count, 3, figsize=(10.8, 3.4 * count), squeeze=False)
    rows = [row for axes, modulus in zip(grid, parsed.modulus) for row in draw_row(study, axes, modulus, parsed)]
    words = ["--meshes", *map(str, parsed.meshes), "--modulus", *(f"{m:g}" for m in parsed.modulus)]
    footer(figure, "$ " + studies.command_of(__file__, *words))
    studies.write_table(parsed.output / "wrinkles.csv", [
        "modulus", "elements_per_side", "element_size", "degree", "wavelength", "short_share",
        "taylor_inertia", "range", "seconds"], rows)
    style.save(figure, parsed.output / "wrinkles.png")


if __name__ == "__main__":
    answer(main)
