"""The columns of results; they stand beside the functions that make them."""

from linepose.estimation.outliers import OUTLIERS as OUTLIERS
from linepose.experiments.truth_error import TRUTH_ERROR as TRUTH_ERROR
from linepose.inputs.labels.labelled_views import POINTS as POINTS
from linepose.inputs.local_frame import MAP_FRAME as MAP_FRAME
from linepose.inputs.observed_points import SCAN_POINTS as SCAN_POINTS
from linepose.inputs.targets.measured import DETECTION as DETECTION
from linepose.inputs.targets.measured import EXTRACTION_ACCURACY as EXTRACTION_ACCURACY
from linepose.pipeline.residual_tables import ESTIMATED_POINTS as ESTIMATED_POINTS
from linepose.pipeline.residual_tables import RESIDUALS as RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS as DIAGNOSTICS
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS as LAPLACE_SIGMA_COLUMNS
from linepose.pipeline.stages import OPTIMA as OPTIMA
from linepose.pipeline.stages import POSE as POSE
from linepose.pipeline.stages import SAMPLES as SAMPLES
from linepose.pipeline.stages import laplace_sigma_columns as laplace_sigma_columns
from linepose.survey.navigation import NAVIGATION_SIGMA as NAVIGATION_SIGMA
from linepose.survey.observations import OBSERVATIONS as OBSERVATIONS
from linepose.tables import flags as flags
from linepose.tables import floats as floats
from linepose.tables import optional_floats as optional_floats
from linepose.tables import texts as texts
from linepose.tables import whole_numbers as whole_numbers
from linepose.tables import with_parameters as with_parameters
