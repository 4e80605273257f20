"""The figures: trajectory and Euler angles as the paper draws them (figures 9 and 10), and the windows' growth."""

import matplotlib

matplotlib.use("svg")
import numpy as np
from matplotlib import pyplot as plt

plt.rcParams.update({
    "font.size": 8, "axes.titlesize": 9, "axes.grid": True, "grid.linewidth": 0.3, "lines.linewidth": 1.1,
    "svg.hashsalt": "second simulator", "svg.fonttype": "none", "font.family": "sans-serif",
    "path.simplify": True, "path.simplify_threshold": 0.6,
})  # fmt: skip
OURS, VERTICAL, PITCHED = "#1f4e9c", "#c8651b", "#3a8a3a"
STYLES = ((OURS, "-"), (VERTICAL, "-"), (PITCHED, "--"))


def save(figure, path):
    """As SVG, the same bytes for the same figure."""
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def trajectory(flights, path):
    """In space, as figures 6 and 9 of the paper, and the take-offs from the side."""
    figure = plt.figure(figsize=(7.6, 5.4))
    shown = (flights[0], flights[2])
    for i, (name, record, phases) in enumerate(shown):
        axes = figure.add_axes((0.0 + 0.5 * i, 0.35, 0.46, 0.58), projection="3d")
        keep = slice(None, None, max(1, len(record["time"]) // 220))
        east, north, up = record["east"], record["north"], -record["down"]
        axes.plot(east[keep], north[keep], up[keep], color=(OURS, PITCHED)[i])
        axes.plot(east[keep], north[keep], 0 * up[keep], color="0.7", linewidth=0.7)
        at = [int(np.searchsorted(record["time"], time)) for time, _ in phases]
        at = [each for each in at if each < len(east)]
        axes.plot(east[at], north[at], up[at], linestyle="none", marker="o", markersize=2.2, color="0.2")
        axes.plot(east[:1], north[:1], 0 * up[:1], linestyle="none", marker="^", markersize=5, color="0.2")
        axes.set_title(name)
        axes.set_xlabel("east, m", labelpad=-3)
        axes.set_ylabel("north, m", labelpad=-3)
        axes.text2D(0.0, 0.83, "height, m", transform=axes.transAxes)
        axes.tick_params(labelsize=6, pad=-1)
        axes.set_box_aspect((1.2, 1, 0.6), zoom=1.08)
        axes.locator_params(nbins=4)
        axes.view_init(30, -60)
    axes = figure.add_axes((0.08, 0.09, 0.9, 0.24))
    for (name, record, _), (colour, style) in zip(flights, STYLES):
        along = np.hypot(record["north"], record["east"])
        until = int(np.argmax(along > 700)) or len(along)
        axes.plot(along[:until], -record["down"][:until], color=colour, linestyle=style, label=name)
    axes.set_xlabel("distance from the start, m")
    axes.set_ylabel("height, m")
    axes.legend(loc="lower right", fontsize=7)
    axes.set_xlim(-10, 700)
    save(figure, path)


def euler(flights, path):
    """Roll, pitch and yaw over time, one row each."""
    figure, rows = plt.subplots(3, 1, figsize=(7.6, 5.4), sharex=True)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.88, bottom=0.08, hspace=0.1)
    for (name, record, _), (colour, style) in zip(flights, STYLES):
        keep = slice(None, None, max(1, len(record["time"]) // 450))
        for axes, angle in zip(rows, ("roll", "pitch", "heading")):
            values = np.degrees(record[angle])
            if angle == "heading":
                values = np.degrees(np.unwrap(record[angle]))
                values = values - 360 * np.round((values[0] - 270) / 360)
            axes.plot(record["time"][keep], values[keep], color=colour, linestyle=style, label=name)
    for axes, name in zip(rows, ("roll, deg", "pitch, deg", "yaw, deg")):
        axes.set_ylabel(name)
    for time, phase in flights[0][2]:
        for axes in rows:
            axes.axvline(time, color="0.8", linewidth=0.6, zorder=0)
        if "hover" not in phase.split() or phase == "hover turn":
            at = rows[0].get_xaxis_transform()
            if phase != "on the ground":
                rows[0].text(
                    time, 1.03, phase, transform=at, fontsize=6.5, rotation=35, color="0.3", va="bottom"
                )
    rows[2].legend(loc="lower left", framealpha=0.9)
    rows[2].set_xlabel("time, s (the phases named are those of ours)")
    rows[2].set_xlim(0, None)
    save(figure, path)


def growth(windows, path):
    """The difference of attitude over a window, as it begins and with the first acceleration matched."""
    figure, pair = plt.subplots(1, 2, figsize=(7.6, 3.2), sharey=True, layout="constrained")
    colours = plt.colormaps["tab10"].colors
    for k, (axes, title) in enumerate(zip(pair, ("as recorded", "first acceleration matched"))):
        for i, (name, time, *both) in enumerate(windows):
            axes.plot(both[k][:, 0], both[k][:, 1], color=colours[i % 10], label=f"{name}, {time:.0f} s")
        axes.axhline(2, color="0.4", linewidth=0.8, linestyle=":")
        axes.set_title(title)
        axes.set_xlabel("time in the window, s")
        axes.set_xlim(0, None)
    pair[0].set_ylabel("difference of attitude, deg")
    pair[0].set_ylim(0, 12)
    pair[1].legend(fontsize=6, loc="upper left")
    save(figure, path)
