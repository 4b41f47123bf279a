def asked_for(platform):
    """The experiments' results that a platform's file asks for."""
    experiments = PROJECT.platforms[platform].experiments
    repeatability = experiments.repeatability
    asked = {
        "uncertainty": True,
        "prior": True,
        "clock_offset": experiments.clock_offset,
        "subsets": experiments.subsets,
        "repeatability": repeatability and repeatability.first,
        "splits": repeatability and repeatability.n_splits,
        "leave_one_out": repeatability,
        "basin_summary": experiments.basin,
        "mapping_summary": experiments.mapping,
        "sensitivity": experiments.sensitivity,
        "noise_models": experiments.noise_models,
        "consistency_summary": experiments.noise_models,
    }
    return [
        f"results/{platform}/{key}.parquet" for key, value in asked.items() if value
    ]


def results_of(platform):
    """Every result of a platform that people read."""
    always = ["pose", "diagnostics"]
    against_truth = (
        ["truth_error", "detection"] if platform in PROJECT.simulated else []
    )
    return asked_for(platform) + [
        f"results/{platform}/{key}.parquet" for key in always + against_truth
    ]


def others(key):
    """Platforms that the experiment of this key compares with."""
    return lambda wildcards: getattr(
        PROJECT.platforms[wildcards.platform].experiments, key
    ).platforms


def of_others(key, result):
    """This result of the platforms that the experiment of this key compares with."""
    return lambda wildcards: expand(
        f"results/{{other}}/{result}.parquet", other=others(key)(wildcards)
    )


def settings_of_others(key):
    """What the files of the platforms say that the experiment of this key compares with."""
    return lambda wildcards: {
        name: PROJECT.platforms[name].model_dump(
            mode="json",
            exclude={"description", "experiments", "map_frame"},
        )
        for name in others(key)(wildcards)
    }


def drawn_from(wildcards):
    """The results that a platform's figures are drawn from, beside those that every platform has."""
    experiments = PROJECT.platforms[wildcards.platform].experiments
    repeatability = experiments.repeatability
    asked = {
        "repeatability": repeatability and repeatability.first,
        "splits": repeatability and repeatability.n_splits,
        "basin": experiments.basin,
        "basin_summary": experiments.basin,
        "mapping": experiments.mapping,
        "mapping_summary": experiments.mapping,
        "weights": experiments.noise_models,
        "identifiability": experiments.noise_models,
        "consistency": experiments.noise_models,
        "consistency_summary": experiments.noise_models,
        "detected_points": wildcards.platform in PROJECT.simulated,
    }
    return [
        f"results/{wildcards.platform}/{key}.parquet"
        for key, value in asked.items()
        if value
    ]


def reported(wildcards):
    """Every result that the report's summaries and sections rest on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    known = [
        file
        for platform in PLATFORMS
        for file in asked_for(platform)
        if Path(file).stem
        in (
            "splits",
            "leave_one_out",
            "sensitivity",
            "subsets",
            "noise_models",
            "consistency_summary",
            "prior",
            "clock_offset",
        )
    ]
    return known + expand(
        "results/{platform}/{name}.parquet", platform=PLATFORMS, name=always
    )


def figure_labels(wildcards):
    """A figure's title and its number in the paper, for Snakemake's report."""
    index = read_table(f"results/{wildcards.platform}/figures/index.parquet")
    entry = index.set_index("figure").loc[wildcards.figure]
    return {"figure": entry["title"], "paper": entry["paper_figure"] or "beyond it"}


def covered_cells(_):
    """Every platform, regime and noise model of the coverage study."""
    cells = [
        f"results/coverage/cells/{platform}/{regime}/{model}.parquet"
        for platform in PROJECT.covered
        for regime, section in STUDY.coverage.regimes.items()
        for model in section.noise_models
    ]
    if not cells:
        raise WorkflowError(
            "config/config.yaml: coverage: found no regime or no simulated platform, expected at least one of each; "
            "add them under coverage.regimes and platforms"
        )
    return cells
