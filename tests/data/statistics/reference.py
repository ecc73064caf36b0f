"""Writes reference.json: what SciPy and statsmodels answer to data of many kinds.

Run with: python3 reference.py > reference.json (numpy 2.4, scipy 1.17, statsmodels 0.15)
"""

import itertools
import json

import numpy as np
import pandas as pd
import scipy.stats as st
import statsmodels.formula.api as smf
from statsmodels.stats.anova import anova_lm
from statsmodels.stats.multicomp import pairwise_tukeyhsd

rng = np.random.default_rng(20)
names = "abcdef"


def plain(numbers):
    return [float(f"{x:.6g}") for x in numbers]


def factorial(shape, counts, effects=1.0, skew=False):
    """A design with counts(cell number) values a cell."""
    rows = []
    for number, cell in enumerate(itertools.product(*[range(n) for n in shape])):
        for _ in range(counts(number)):
            noise = rng.exponential() if skew else rng.normal()
            rows.append((*cell, effects * np.sin(number * 1.7 + cell[0]) + noise))
    columns = list(names[: len(shape)])
    data = pd.DataFrame(rows, columns=[*columns, "y"])
    data["y"] = plain(data["y"])
    model = smf.ols("y ~ " + " * ".join(f"C({c})" for c in columns), data).fit()
    table = anova_lm(model, typ=2)
    found = {}
    for source, row in table.iterrows():
        source = source.replace("C(", "").replace(")", "").lower()
        found[source] = {
            "ss": row["sum_sq"],
            "df": int(row["df"]),
            "f": None if np.isnan(row["F"]) else row["F"],
            "p": None if np.isnan(row["PR(>F)"]) else row["PR(>F)"],
        }
    shapiro = st.shapiro(model.resid)
    levene = st.levene(*[g["y"] for _, g in data.groupby(columns)], center="median")
    return {
        "shape": shape,
        "levels": data[columns].to_numpy().tolist(),
        "values": data["y"].tolist(),
        "rows": found,
        "shapiro_w": shapiro.statistic,
        "shapiro_p": shapiro.pvalue,
        "levene_f": levene.statistic,
        "levene_p": levene.pvalue,
    }


def gaps(shape, counts):
    """A design with empty cells: statsmodels' own table counts columns that are not there, so models are compared."""
    cells = list(enumerate(itertools.product(*[range(n) for n in shape])))
    rows = [(*cell, np.sin(number) + rng.normal()) for number, cell in cells for _ in range(counts(number))]
    columns = list(names[: len(shape)])
    data = pd.DataFrame(rows, columns=[*columns, "y"])
    data["y"] = plain(data["y"])
    terms = [t for n in range(1, len(shape) + 1) for t in itertools.combinations(columns, n)]

    def fit(of):
        formula = "y ~ 1" + "".join(" + " + ":".join(f"C({c})" for c in t) for t in of)
        return smf.ols(formula, data).fit()

    full, found = fit(terms), {}
    for term in terms:
        others = [t for t in terms if not set(term) <= set(t)]
        less, more = fit(others), fit([*others, term])
        df = int(round(less.df_resid - more.df_resid))
        ss = less.ssr - more.ssr
        f = ss / df / full.mse_resid if df else None
        p = st.f.sf(f, df, full.df_resid) if df else None
        found[":".join(term)] = {"ss": ss, "df": df, "f": f, "p": p}
    found["residual"] = {"ss": full.ssr, "df": int(full.df_resid), "f": None, "p": None}
    return {"shape": shape, "levels": data[columns].to_numpy().tolist(), "values": data["y"].tolist(), "rows": found}


def tukey(sizes, alpha):
    groups = [plain(rng.normal(loc=0.5 * i, size=n)) for i, n in enumerate(sizes)]
    labels = [chr(ord("a") + i) for i, n in enumerate(sizes) for _ in range(n)]
    found = pairwise_tukeyhsd(np.concatenate(groups), labels, alpha=alpha)
    return {
        "alpha": alpha,
        "groups": groups,
        "meandiff": found.meandiffs.tolist(),
        "p_adj": found.pvalues.tolist(),
        "lower": found.confint[:, 0].tolist(),
        "upper": found.confint[:, 1].tolist(),
        "reject": found.reject.tolist(),
    }


def shapiro(values):
    values = plain(values)
    found = st.shapiro(values)
    return {"values": values, "w": found.statistic, "p": found.pvalue}


def paired(a, b):
    a, b = plain(a), plain(b)
    t = st.ttest_rel(a, b)
    above = {"zero_method": "wilcox", "correction": False, "method": "asymptotic"}
    both = st.wilcoxon(a, b, **above)
    greater = st.wilcoxon(a, b, alternative="greater", **above)
    return {
        "a": a,
        "b": b,
        "t": t.statistic,
        "df": int(t.df),
        "p": t.pvalue,
        "p_greater": st.ttest_rel(a, b, alternative="greater").pvalue,
        "plus": greater.statistic,
        "rank_z": both.zstatistic,
        "rank_p": both.pvalue,
        "rank_p_greater": greater.pvalue,
    }


twenty = rng.normal(size=20)
reference = {
    "anova": [
        factorial([3], lambda i: 4 + 2 * i),
        factorial([2, 3], lambda i: 3 + i % 4),
        factorial([4, 4], lambda i: 1 + (i * i) % 9, skew=True),
        factorial([2, 2, 3], lambda i: 5),
        factorial([3, 2, 4], lambda i: 1 + (i * 7) % 5),
        factorial([2, 3, 3], lambda i: 1 + 30 * (i % 7 == 0), skew=True),
        factorial([2, 2, 2, 3], lambda i: 2 + i % 3),
        factorial([2, 2, 2, 2, 2], lambda i: 1 + i % 3, effects=40.0),
    ],
    "gaps": [
        gaps([3, 3], lambda i: 0 if i == 5 else 3),
        gaps([2, 3, 3], lambda i: 0 if i in (1, 4, 14) else 1 + i % 3),
        gaps([2, 2], lambda i: 0 if i == 3 else 4),
    ],
    "tukey": [
        tukey([5, 5], 0.05),
        tukey([4, 7, 10], 0.05),
        tukey([20, 3, 8, 2, 15], 0.01),
        tukey([6] * 9, 0.1),
        tukey([2, 2, 2], 0.05),
    ],
    "shapiro": [shapiro(rng.normal(size=n)) for n in [3, 4, 5, 6, 7, 11, 12, 60]]
    + [shapiro(rng.exponential(size=n)) for n in [3, 5, 9, 13, 200]]
    + [shapiro(np.round(rng.normal(size=40), 1) + 1000.0)],
    "range": [
        {"q": q, "groups": k, "df": df, "p": st.studentized_range.sf(q, k, df)}
        for q in [0.3, 1.5, 3.0, 4.2, 8.0, 30.0]
        for k in [2, 7, 50]
        for df in [1, 3, 13, 396, 4000]
    ],
    "quantile": [
        {"alpha": alpha, "groups": k, "df": df, "q": st.studentized_range.isf(alpha, k, df)}
        for alpha in [0.001, 0.05, 0.9]
        for k in [2, 20]
        for df in [2, 10, 396]
    ],
    "f": [
        {"f": f, "between": a, "within": b, "p": st.f.sf(f, a, b)}
        for f in [0.01, 0.9, 1.5, 20.0, 700.0]
        for a in [1, 4, 90]
        for b in [1, 7, 400, 200000]
        if st.f.sf(f, a, b) > 1e-290
    ],
    "paired": [
        paired(twenty + 0.3, twenty + 0.5 * rng.normal(size=20)),
        paired(np.round(rng.normal(size=60), 1), np.round(rng.normal(size=60), 1)),
        paired(rng.normal(size=100) + 3.0, rng.normal(size=100)),
    ],
}
print(json.dumps(reference, allow_nan=False, separators=(",", ":")))
