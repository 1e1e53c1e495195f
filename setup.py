"""The Python package: `pip install .` builds the module by CMake. docs/python.md says how it is used."""
import pathlib
import re

from skbuild import setup

root = pathlib.Path(__file__).parent
version = re.search(r"project\(tenebra VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]

setup(
    name="tenebra",
    version=version,
    description="Exact hard shadows, soft shadows and ambient occlusion on the CPU",
    license="MIT",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["tenebra"],
    package_dir={"": "python"},
    package_data={"tenebra": ["py.typed", "*.pyi"]},
    cmake_args=["-DTENEBRA_PYTHON=ON", "-DTENEBRA_TESTS=OFF", "-DTENEBRA_UNITY=ON"],
    cmake_install_target="install-python",
)
