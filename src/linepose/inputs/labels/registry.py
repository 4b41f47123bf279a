"""The formats of labels that tools write; our own CSV is read beside them."""

from typing import Final

from linepose.inputs.labels.coco import COCO
from linepose.inputs.labels.cvat import CVAT
from linepose.inputs.labels.format import LabelFormat
from linepose.inputs.labels.label_studio import LABEL_STUDIO
from linepose.inputs.labels.labelme import LABELME
from linepose.inputs.labels.via import VIA, VIA_CSV

FORMATS: Final[tuple[LabelFormat, ...]] = (CVAT, LABELME, COCO, LABEL_STUDIO, VIA, VIA_CSV)
