# SPDX-License-Identifier: GPL-3.0-or-later
"""What was learnt of a DEM's error as a page: plain words, figures, warnings, charts, and a map."""

import html

from .charts import Chart, picture
from .pages import page
from .text import tr

_MAP_SHARE = 98  # per cent of the values that the map's colours span
_FEWEST_BEYOND = 2  # residuals beyond a quantile that is shown
_TAILS = (("normal", "first"), ("laplace", "second"), ("student", "third"))


def write_report(path, model, quantile, halfway):
    """`model` is an ErrorModel of estimate_error(), `quantile(confidence, tails)` that of errors of sd 1, `halfway` the
    sd half-way between samples, cell by cell."""
    report = model.report
    parts = [f"<p>{html.escape(in_words(model))}</p>", _table(_model_rows(model))]
    if report["warnings"]:
        notes = "".join(f"<li>{html.escape(note)}</li>" for note in report["warnings"])
        parts.append(f"<h2>{tr('To be looked at')}</h2><ul>{notes}</ul>")
    parts += [f"<h2>{tr('How the error grows with the spacing of samples')}</h2>", _growth(report)]
    parts += [f"<h2>{tr('The error half-way between samples, that of the samples included')}</h2>", _map(halfway)]
    for name, title in (("reference", tr("Against the better elevation model")), ("checkpoints", tr("Against the check points"))):
        if name in report:
            parts += _check(report[name], title, quantile)
    parts.append(f"<h2>{tr('Error model')}</h2><pre>{html.escape(model.to_json())}</pre>")
    path.write_text(page(tr("The error of an elevation model"), parts), encoding="utf-8")


def in_words(model):
    """What was learnt, for people in a hurry."""
    report = model.report
    told = [
        tr("Half-way between its samples the elevation model misses the ground by {:.3g} m (one standard deviation, over all of it).").format(
            report["typical_sigma"]
        )
    ]
    known = [name for name in ("reference", "checkpoints") if name in report]
    if known:
        check = report[known[0]]
        told.append(
            tr("At its samples it is wrong by {:.3g} m on level ground and by {:.3g} m more for each metre of rise per metre.").format(
                check["sigma_at_flat"], check["sigma_per_slope"]
            )
        )
        bias = model.shared_bias
        higher = tr("On the whole it is {:.3g} m too high.") if bias > 0 else tr("On the whole it is {:.3g} m too low.")
        told.append(higher.format(abs(bias)) if bias else tr("On the whole it is neither too high nor too low."))
        if check["correction"]["taken_off"]:
            told.append(tr("All this is said of the model with the shift taken off, and of no other."))
    elif report["rounding"]:
        told.append(tr("Its heights are rounded, which adds {:.3g} m.").format(report["rounding"]))
    else:
        told.append(
            tr("What all samples have in common, such as a bias, it cannot know of itself: check points or a better model tell.")
        )
    return " ".join(told)


def _drawn_tails(model):
    if model.level_tail is None:
        return []
    told = f"{model.level_tail:.2g}; {model.step_tail:.2g}"
    return [(tr("Tails of what is drawn on level ground and on steps (0 is normal, 0.5 laplace)"), told)]


def _model_rows(model):
    report = model.report
    rows = [
        (tr("Error between samples, half a spacing away (m)"), f"{report['typical_sigma']:.4g}"),
        (tr("Growth exponent H"), f"{report['growth_exponent']:.3g}"),
        (tr("Rounding of the heights (m)"), f"{report['rounding']:.3g}"),
        (tr("Error of the samples, vertical and horizontal (m)"), f"{model.vertical_rmse:.4g}; {model.horizontal_rmse:.4g}"),
        (tr("Correlation length of the samples' error (m)"), f"{model.correlation_length:.4g}"),
        (tr("Bias (m, model minus truth)"), f"{model.shared_bias:.4g}"),
        (tr("Tails"), tr(model.tails or "normal")),
        *_drawn_tails(model),
        (tr("A cell holds (0 looks like samples, 1 like means)"), f"{model.samples_or_means} ({report['means_score']:.2g})"),
        (tr("Ridges and valleys planed off (m per m of curvature)"), f"{report['ridge_gain']:.3g}"),
    ]
    check = report["self_check"]
    if check["places"]:
        told = "; ".join(f"{check[name]:.3g}" for name in ("median", "q90", "q95", "q99"))
        rows.append((tr("Own samples out of every other: 50, 90, 95 and 99 % lie within so many sigma"), told))
    return rows


def _growth(report):
    chart = Chart(tr("spacing of the samples (cells)"), tr("error half-way between (m)"), log_x=True, log_y=True)
    measured = [(2.0**power, rms) for power, rms in enumerate(report["rms_of_spacing"], 1) if rms > 0]
    typical = report["typical_sigma"]
    law = [(spacing, typical * spacing ** report["growth_exponent"]) for spacing in (1.0, *(one for one, _ in measured))]
    chart.line(law if len(law) > 1 else [], "first", tr("spacing^{:.2f}").format(report["growth_exponent"]))
    chart.dots(measured, "dot", tr("measured"))
    chart.dots([(1.0, typical)], "ring", tr("expected of the model"))
    return chart.svg() or f"<p>{tr('Nothing could be measured.')}</p>"


def _map(halfway):
    import numpy

    known = halfway[numpy.isfinite(halfway)]
    if not known.size:
        return f"<p>{tr('Nothing is known anywhere.')}</p>"
    largest = float(numpy.percentile(known, _MAP_SHARE))
    middle = float(numpy.median(known))
    caption = tr("From pale (0) to dark ({:.3g} m and more); half of the ground is below {:.3g} m.").format(largest, middle)
    return f"{picture(halfway, largest)}<p>{caption}</p>"


def _check(check, title, quantile):
    parts = [f"<h2>{title}</h2>", _table(_check_rows(check))]
    parts += [f"<h3>{tr('Residuals, in units of their sigma')}</h3>", _quantiles(check, quantile)]
    parts += [f"<h3>{tr('Variogram: how far errors are alike')}</h3>", _variogram(check["variogram"])]
    parts += [f"<h3>{tr('Growth with slope')}</h3>", _slope(check)]
    return parts


def _check_rows(check):
    rows = [
        (tr("Places compared; left out for want of a height"), f"{check['count']}; {check['left_out']}"),
        (tr("Bias: mean, median (m, model minus truth)"), f"{check['mean']:.4g}; {check['median']:.4g}"),
        (tr("RMSE; standard deviation; NMAD (m)"), f"{check['rmse']:.4g}; {check['sd']:.4g}; {check['nmad']:.4g}"),
        (tr("LE90; LE95 (m)"), f"{check['le90']:.4g}; {check['le95']:.4g}"),
        (tr("LE90; LE95 with the bias taken off (m)"), f"{check['le90_unbiased']:.4g}; {check['le95_unbiased']:.4g}"),
        (tr("Skewness; excess kurtosis"), f"{check['skewness']:.3g}; {check['excess_kurtosis']:.3g}"),
        (tr("Tails"), tr(check["tails"])),
        (tr("Farther than 5 NMAD from the median"), f"{check['outliers']}"),
        (tr("Of the error, between-sample part that was taken off (m)"), f"{check['between_samples']:.4g}"),
        (tr("Error that is explained by slope; by curvature"), f"{check['slope']['explained']:.0%}; {check['curvature']['explained']:.0%}"),
        (tr("Truth above the model on convex ground (m per m of curvature)"), f"{check['ridge_bias']:.3g}"),
    ]
    if "samples_or_means" in check:
        rows.append((tr("A cell holds, as the better model shows"), tr(check["samples_or_means"])))
    shift = check["shift"]
    if shift:
        places = tr("{dx:.3g} ± {se_dx:.2g} east, {dy:.3g} ± {se_dy:.2g} north, {dz:.3g} ± {se_dz:.2g} up").format(**shift)
        state = tr("taken off") if shift["corrected"] else tr("not taken off")
        state = state if shift["significant"] else tr("no more than chance")
        rows.append((tr("The model lies beside the truth by (m)"), f"{places}: {state}"))
    return rows


def _quantiles(check, quantile):
    chart = Chart(tr("share of the residuals that lie beyond (%)"), tr("so many sigma"), log_x=True, log_y=True)
    confidences = check["confidences"]
    enough = [c for c in confidences if check["count"] * (1 - c) >= _FEWEST_BEYOND]
    for name, style in _TAILS:
        chart.line([(100 * (1 - c), quantile(c, name)) for c in enough], style, tr(name))
    measured = [(100 * (1 - c), q) for c, q in zip(confidences, check["quantiles"]) if c in enough]
    chart.dots(measured, "dot", tr("measured"))
    return chart.svg()


def _variogram(variogram):
    chart = Chart(tr("distance (m)"), tr("half the mean square difference (m²)"), log_x=True)
    distances = variogram["distance"]
    chart.line(list(zip(distances, variogram["fitted"])), "first", tr("fitted"))
    chart.dots(list(zip(distances, variogram["semivariance"])), "dot", tr("measured"))
    if variogram["length"]:
        told = tr("Alike over {:.3g} m (1/e); {:.3g} m² of it is each place's own, {:.3g} m² is shared.").format(
            variogram["length"], variogram["nugget"], variogram["sill"]
        )
    else:
        told = tr("No likeness of neighbouring errors is to be seen.")
    return chart.svg() + f"<p>{told}</p>"


def _slope(check):
    slope = check["slope"]
    chart = Chart(tr("slope (metres up per metre)"), tr("sigma of the samples (m)"))
    ends = [0.0, max(slope["value"], default=0.0)]
    chart.line([(t, check["sigma_at_flat"] + check["sigma_per_slope"] * t) for t in ends], "first", tr("fitted"))
    chart.dots(list(zip(slope["value"], slope["sigma"])), "dot", tr("measured"))
    return chart.svg()


def _table(rows):
    return "<table>" + "".join(f"<tr><th>{name}</th><td>{html.escape(value)}</td></tr>" for name, value in rows) + "</table>"
