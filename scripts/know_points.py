"""What is known of a platform's points beside their measurements, by their names."""

from pathlib import Path

from adapter import stage

with stage(snakemake) as log:
    from linepose.config.platform import Platform
    from linepose.inputs.local_frame import MAP_FRAME
    from linepose.pipeline.known_points import known_points
    from linepose.pipeline.survey_frame import survey_frame
    from linepose.survey.observations import OBSERVATIONS, survey_from_table
    from linepose.survey.point_knowledge import KNOWN_POINTS, knowledge_table
    from linepose.tables import read_table, write_table

    platform, folder = Platform.model_validate(snakemake.params.platform), Path(snakemake.params.folder)
    survey = survey_from_table(read_table(snakemake.input.observations, OBSERVATIONS))
    frame = survey_frame(snakemake.params.map_frame, read_table(snakemake.input.frame, MAP_FRAME))
    known = known_points(platform, folder, survey, frame)
    write_table(knowledge_table(known), snakemake.output[0], KNOWN_POINTS)
    log.info("%d points of which something is known", len(known))
