"""The figures of the two papers, per cent unless said otherwise.

THESIS: Semi-automated generation of horizontally curved driving lines from mobile laser scanning
(University of Waterloo, 2018), RIEGL VMX-450, Xiamen. PAPER: road boundary extraction from normalized
scanlines (ISPRS Archives, 2020), MX-8, Inagi. Typing errors of the originals are as in their tables.
"""

# table 4.2: points of the survey and of the road
ROAD_POINTS = ((6_568_656, 3_717_442), (3_928_845, 1_952_461), (5_693_607, 3_275_666), (2_063_626, 1_202_819),
               (3_661_745, 2_575_698), (18_561_253, 4_714_745))
# table 4.3: megabytes by cell size in cm
IMAGE_SIZE = {"2": 19.2, "4": 3.22, "6": 1.42, "8": 0.83, "10": 0.53}
# table 4.12: seconds of data sets 1 to 6
SECONDS = {
    "Road surface": (41.25, 36.03, 40.62, 13.32, 34.58, 82.62),
    "Marking extraction": (12.44, 15.93, 22.32, 9.05, 21.24, 47.50),
    "Outlier removal": (1.62, 0.76, 1.54, 1.49, 4.02, 3.30),
    "Clustering": (14.84, 11.16, 6.03, 19.52, 27.43, 31.79),
    "Lines": (0.03, 0.04, 0.02, 0.01, 0.03, 0.05),
    "Whole": (70.18, 63.92, 70.53, 43.39, 87.30, 165.26),
}
# table 4.13: recall, precision, F1 of data sets 1 to 6 and their mean
MARKINGS = ((90.06, 92.53, 91.28), (93.73, 95.04, 94.38), (90.42, 93.05, 91.72), (88.02, 89.59, 88.80), (92.71, 94.97, 93.83),
            (90.42, 93.05, 91.72), (90.89, 93.04, 91.95))
# table 4.14: mean recall, precision, F1 over data sets 1, 4 and 5
METHODS = {"intensity-peaks": (76.91, 91.27, 83.42), "point-segments": (81.15, 91.17, 85.81), "multi-threshold": (90.26, 92.36, 91.30)}
# table 4.15: recall and miscoding of two driving lines by buffer in cm
DRIVING = {"5": ((74.82, 24.48), (70.98, 28.23)), "10": ((92.33, 7.24), (91.27, 8.32)), "15": ((100.0, 0.0), (100.0, 0.0)),
           "20": ((100.0, 0.0), (100.0, 0.0))}
# the paper's table 3: precision, recall, F
BOUNDARIES = {"drive A, left": (95.37, 93.71, 94.53), "drive A, right": (94.96, 93.62, 94.29), "drive B, left": (96.50, 92.45, 94.43),
              "drive B, right": (92.80, 92.41, 92.60), "total": (94.89, 93.01, 93.94)}
