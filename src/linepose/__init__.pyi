from linepose.check.platform import check_platform as check_platform
from linepose.errors import EstimationError as EstimationError
from linepose.errors import InputError as InputError
from linepose.errors import LineposeError as LineposeError
from linepose.estimation.optimise import Search as Search
from linepose.estimation.sampling import IndependenceSettings as IndependenceSettings
from linepose.estimation.sampling import SamplingSettings as SamplingSettings
from linepose.geometry.camera import Camera as Camera
from linepose.geometry.camera import CameraSigmas as CameraSigmas
from linepose.pipeline.api import calibrate_platform as calibrate_platform
from linepose.pipeline.api import load_observations as load_observations
from linepose.pipeline.api import load_platform_file as load_platform_file
from linepose.pipeline.api import observations_from_arrays as observations_from_arrays
from linepose.pipeline.calibrate import CalibrationSettings as CalibrationSettings
from linepose.pipeline.calibrate import calibrate as calibrate
from linepose.pipeline.calibration import Calibration as Calibration
from linepose.survey.hand_measured import HandMeasured as HandMeasured

__version__: str
