from .adjustment.settings import AdjustmentSection as AdjustmentSection
from .check.platform import check_platform as check_platform
from .errors import EstimationError as EstimationError
from .errors import InputError as InputError
from .errors import LineposeError as LineposeError
from .estimation.optimise import Search as Search
from .estimation.sampling import SamplingSettings as SamplingSettings
from .geometry.camera import Camera as Camera
from .geometry.camera_sigmas import CameraSigmas as CameraSigmas
from .pipeline.api import calibrate_platform as calibrate_platform
from .pipeline.api import load_observations as load_observations
from .pipeline.api import load_platform_file as load_platform_file
from .pipeline.api import observations_from_arrays as observations_from_arrays
from .pipeline.calibrate import CalibrationSettings as CalibrationSettings
from .pipeline.calibrate import calibrate as calibrate
from .pipeline.calibration import Calibration as Calibration
from .pipeline.comparison import Comparison as Comparison
from .pipeline.comparison import compare as compare
from .pipeline.recheck import Recheck as Recheck
from .pipeline.recheck import recheck_platform as recheck_platform
from .survey.hand_measured import HandMeasured as HandMeasured

__version__: str
