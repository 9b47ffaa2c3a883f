"""Checks that the conda recipe can be rendered, on each platform for which conda-forge builds packages.

    python3 scripts/check_recipe.py

Uses py-rattler-build, which `./test release` installs. It does not build: that needs the packages of conda-forge.
"""

from pathlib import Path

from rattler_build import PlatformConfig, RenderConfig, Stage0Recipe, VariantConfig

RECIPE = Path(__file__).parents[1] / "python/conda/recipe.yaml"
# What conda-forge's own configuration gives.
VARIANT = """
python: ["3.13.* *_cp313"]
c_compiler: [gcc]
rust_compiler: [rust]
"""

for platform in ("linux-64", "linux-aarch64", "osx-64", "osx-arm64", "win-64"):
    recipe = Stage0Recipe.from_yaml(RECIPE.read_text())
    config = RenderConfig(platform=PlatformConfig(target_platform=platform))
    variants = recipe.render(VariantConfig.from_yaml(VARIANT), config)
    assert len(variants) == 1, variants
    rendered = variants[0].recipe.to_dict()
    assert rendered["package"]["name"] == "sweep-and-prune", rendered
    print(f"{platform}: {rendered['package']['name']} {rendered['package']['version']}")
