rule experiments:
    input:
        [file for platform in PLATFORMS for file in asked_for(platform)],
