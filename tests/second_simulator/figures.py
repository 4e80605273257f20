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
    """In space: east, north, height; where each phase begins is a dot."""
    figure = plt.figure(figsize=(7.6, 3.6), layout="constrained")
    for i, (name, record, phases) in enumerate(flights):
        axes = figure.add_subplot(1, len(flights), i + 1, projection="3d")
        keep = slice(None, None, max(1, len(record["time"]) // 220))
        east, north, up = record["east"], record["north"], -record["down"]
        axes.plot(east[keep], north[keep], up[keep], color=STYLES[i][0])
        axes.plot(east[keep], north[keep], 0 * up[keep], color="0.75", linewidth=0.7)
        at = [int(np.searchsorted(record["time"], time)) for time, _ in phases]
        at = [each for each in at if each < len(east)]
        axes.plot(east[at], north[at], up[at], linestyle="none", marker="o", markersize=2.2, color="0.2")
        axes.plot(east[:1], north[:1], up[:1], linestyle="none", marker="^", markersize=5, color="0.2")
        axes.set_title(name)
        axes.set_xlabel("east, m", labelpad=-4)
        axes.set_ylabel("north, m", labelpad=-4)
        axes.set_zlabel("height, m", labelpad=-5)
        axes.tick_params(labelsize=6, pad=-2)
        axes.set_box_aspect((1, 1, 0.55))
        axes.locator_params(nbins=4)
        axes.view_init(28, -125)
    save(figure, path)


def euler(flights, path):
    """Roll, pitch and yaw over time, one row each."""
    figure, rows = plt.subplots(3, 1, figsize=(7.6, 5.2), sharex=True, layout="constrained")
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
    low, high = rows[0].get_ylim()
    rows[0].set_ylim(low, high + 0.25 * (high - low))
    for time, phase in flights[0][2]:
        for axes in rows:
            axes.axvline(time, color="0.8", linewidth=0.6, zorder=0)
        if phase not in ("on the ground", "marker", "hover over the start"):
            rows[0].text(time + 0.8, high, phase, fontsize=6, rotation=28, color="0.35", va="bottom", clip_on=False)
    rows[2].legend(loc="lower left", ncols=1, framealpha=0.9)
    rows[2].set_xlabel("time, s (phases: those of the demonstration)")
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
