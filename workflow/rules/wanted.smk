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
    }
    return [
        f"results/{platform}/{key}.parquet" for key, value in asked.items() if value
    ]


def others(wildcards):
    """Platforms that the sensitivity experiment compares with."""
    return PROJECT.platforms[wildcards.platform].experiments.sensitivity.platforms


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
    }
    return [
        f"results/{wildcards.platform}/{key}.parquet"
        for key, value in asked.items()
        if value
    ]


def reported(wildcards):
    """Every result that the report's summaries rest on."""
    always = ["observations", "outliers", "optima", "pose", "diagnostics", "residuals"]
    known = [
        file
        for platform in PLATFORMS
        for file in asked_for(platform)
        if Path(file).stem in ("splits", "leave_one_out", "prior", "clock_offset")
    ]
    return known + expand(
        "results/{platform}/{name}.parquet", platform=PLATFORMS, name=always
    )
