"""Maps of the atlas about the membrane: compression, pre-stress, bending, the form of the load."""

from package import PENS, RATIO, SHEAR, SIDE, line, numpy, plt, style, ticks
import waves


def load_form(study, given):
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.6), sharey=True)
    rows = []
    for axis, ca in zip(axes, given["values"]):
        for load, color, offset in (("strong", style.RUNS[1], -0.19), ("weak", style.RUNS[0], 0.19)):
            for k, (mesh, settings) in enumerate(given["cases"].items()):
                outcome = study.run(given["deck"], given["base"] | settings | {"Membrane/capillary number": ca,
                                                                       "Membrane/load": load})
                axis.barh(k + offset, outcome.end, 0.34, color=color, label=f"{load} form" if k == 0 else None)
                axis.annotate(f"{outcome.end:.2f}", (0, k + offset), (3, 0), textcoords="offset points", va="center",
                              fontsize=7.5, color="white")
                rows.append((ca, mesh, load, outcome.end, outcome.message[:100]))
        axis.set(title=f"Ca = {ca:g}", xlabel="time reached", xlim=(0, given["base"]["Time/final time"]))
        axis.grid(visible=False, axis="y")
    axes[1].plot(0.664, 1 - 0.19, "x", color=style.INK, ms=7, mew=1.6, label="paper")
    axes[0].set_yticks(range(len(given["cases"])), given["cases"])
    axes[0].invert_yaxis()
    figure.legend(*axes[1].get_legend_handles_labels(), loc="upper right", ncols=3)
    return figure, ["capillary_number", "mesh", "load", "time_reached", "message"], rows


def buckling(study, given):
    cures = {"bending 0.02 R²G_s": lambda ca: {"Membrane/bending modulus": 0.02 / ca}, "as it is": lambda ca: {},
             "pre-inflation 5 %": lambda ca: {"Membrane/pre-inflation": 0.05}, "λ = 5": lambda ca: {RATIO: 5.0}}
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4))
    rows = []
    for (name, cure), pen in zip(cures.items(), PENS):
        for n, dash in (6, ":"), (9, "-"):
            jobs = {ca: given["base"] | cure(ca) | {SIDE: n, "Membrane/capillary number": ca} for ca in given["values"]}
            rows += line(study, (left, right), f"{name}, n = {n}", SHEAR, jobs, (
                "smallest_tension", lambda one: waves.short_share(one.run)), linestyle=dash, **pen)
    left.axhline(0, color=style.FAINT, linewidth=0.9)
    for axis, label in (left, "smallest tension over G_s"), (right, "share of the load in degrees ≥ 9"):
        ticks(axis, given["values"], "Ca")
        axis.set_ylabel(label)
    right.set_yscale("log")
    left.legend(loc="best", fontsize=7)
    return figure, ["cure", "capillary_number", "smallest_tension", "short_share", "message"], rows


def pre_inflation(study, given):
    capillary, inflation = given["values"], given["inflations"]
    pairs = [(ca, alpha) for alpha in inflation for ca in capillary]
    outcomes = study.all([(SHEAR, given["base"] | {"Membrane/capillary number": ca, "Membrane/pre-inflation": alpha})
                          for ca, alpha in pairs])
    smallest = [outcome.series["smallest_tension"].min() if outcome.done else numpy.nan for outcome in outcomes]
    field = numpy.reshape(smallest, (len(inflation), len(capillary)))
    bound = numpy.nanmax(abs(field))
    x, y = numpy.meshgrid(capillary, 100 * numpy.array(inflation))
    figure, axis = plt.subplots(figsize=(7.2, 4.6))
    filled = axis.contourf(x, y, field, numpy.linspace(-bound, bound, 21), cmap=style.SIGNED)
    axis.contour(x, y, field, [0], colors=style.INK, linewidths=1.4)
    axis.plot(x, y, ".", color=style.INK, ms=2)
    ticks(axis, capillary, "Ca")
    axis.set_ylabel("pre-inflation α, per cent")
    axis.grid(visible=False)
    figure.colorbar(filled, label="smallest tension over G_s")
    rows = [(*pair, value) for pair, value in zip(pairs, smallest)]
    return figure, ["capillary_number", "pre_inflation", "smallest_tension"], rows
