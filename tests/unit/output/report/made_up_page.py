"""What the made-up report is held against."""

import pandas as pd

REGRESSION = pd.DataFrame(
    {
        "quantity": [
            "made-up, Table 3, r_x_m",
            "made-up, Table 3, r_y_m",
            "made-up, notebook, neg_log_likelihood",
            "other, planted fault 7 removed",
            "other, planted fault 9 removed",
        ],
        "published": [0.19, -0.10, 51.5, 1.0, 1.0],
        "obtained": [0.19, -0.14, 60.0, 1.0, 1.0],
        "tolerance": [0.01, 0.01, 0.1, 0.0, 0.0],
        "passed": [True, False, False, True, True],
        "known_deviation": [False, True, False, False, False],
        "note": ["", "printed wrongly", "", "", ""],
    }
)
