def asked_for(platform):
    """The experiments' results that a platform's file asks for."""
    experiments = PROJECT.platforms[platform].experiments
    repeatability = experiments.repeatability
    asked = {
        "uncertainty": True,
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


rule experiments:
    input:
        [file for platform in PLATFORMS for file in asked_for(platform)],
