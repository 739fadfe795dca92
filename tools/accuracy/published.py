"""The figures of the two papers as rows of results, per cent unless said otherwise.

THESIS: Semi-automated generation of horizontally curved driving lines from mobile laser scanning
(University of Waterloo, 2018), RIEGL VMX-450, Xiamen. PAPER: road boundary extraction from normalized
scanlines (ISPRS Archives, 2020), MX-8, Inagi. Typing errors of the originals are as in their tables.
"""

RATES = ("recall", "precision", "f1")
# table 4.2: points of the survey and of the road
_ROAD_POINTS = ((6_568_656, 3_717_442), (3_928_845, 1_952_461), (5_693_607, 3_275_666), (2_063_626, 1_202_819),
                (3_661_745, 2_575_698), (18_561_253, 4_714_745))
# table 4.3: megabytes by cell size in cm
_IMAGE_SIZE = {"2": 19.2, "4": 3.22, "6": 1.42, "8": 0.83, "10": 0.53}
# table 4.12: seconds, mean of data sets 1 to 6 (i5-6400, C++ with PCL)
_SECONDS = {"road surface": 41.403, "marking extraction": 21.413, "outlier removal": 2.122, "clustering": 18.462, "lines": 0.03, "whole": 83.43}
# table 4.13: recall, precision, F1 of data sets 1 to 6 and their mean
_MARKINGS = ((90.06, 92.53, 91.28), (93.73, 95.04, 94.38), (90.42, 93.05, 91.72), (88.02, 89.59, 88.80), (92.71, 94.97, 93.83),
             (90.42, 93.05, 91.72), (90.89, 93.04, 91.95))
# table 4.14: mean recall, precision, F1 over data sets 1, 4 and 5
_METHODS = {"intensity-peaks": (76.91, 91.27, 83.42), "point-segments": (81.15, 91.17, 85.81), "multi-threshold": (90.26, 92.36, 91.30)}
# table 4.15: recall and miscoding of two driving lines by buffer in cm
_DRIVING = {"5": ((74.82, 24.48), (70.98, 28.23)), "10": ((92.33, 7.24), (91.27, 8.32)), "15": ((100.0, 0.0), (100.0, 0.0)),
            "20": ((100.0, 0.0), (100.0, 0.0))}
# the paper's table 3: precision, recall, F
_BOUNDARIES = {"drive A, left": (95.37, 93.71, 94.53), "drive A, right": (94.96, 93.62, 94.29), "drive B, left": (96.50, 92.45, 94.43),
               "drive B, right": (92.80, 92.41, 92.60), "total": (94.89, 93.01, 93.94)}
THESIS = [f"thesis, data set {k}" for k in range(1, 7)]
# (table, of, case, {figure: value})
PUBLISHED = (
    *(("survey", name, "", {"points": points, "road points": road}) for name, (points, road) in zip(THESIS, _ROAD_POINTS)),
    *(("cells", "thesis", size, {"megabytes": value}) for size, value in _IMAGE_SIZE.items()),
    *(("seconds", "thesis, mean", stage, {"s": value}) for stage, value in _SECONDS.items()),
    *(("whole", name, "markings", {f"tolerant {rate}": value for rate, value in zip(RATES, row)})
      for name, row in zip([*THESIS, "thesis, mean"], _MARKINGS)),
    *(("methods", "thesis, mean of data sets 1, 4, 5", method, {f"polygons tolerant {rate}": value for rate, value in zip(RATES, row)})
      for method, row in _METHODS.items()),
    *(("whole", f"thesis, line {k + 1}", "driving", {f"{name} {width}": pairs[k][which] for width, pairs in _DRIVING.items()
                                                    for which, name in enumerate(("recall", "miscoding"))}) for k in (0, 1)),
    *(("boundaries", "paper", where, dict(zip(("precision", "recall", "f1"), row))) for where, row in _BOUNDARIES.items()),
)
