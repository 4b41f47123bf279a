"""Labels of pattern points as people's tools write them: our CSV file, LabelMe's JSON, CVAT's XML."""

from linepose.inputs.labels.reading import read_point_labels

__all__ = ["read_point_labels"]
