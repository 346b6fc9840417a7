from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Orbweaver(CMakePackage):
    """Families of periodic orbits of dynamical systems by variational continuation, alone or over MPI.

    There is no tarball to fetch: build from a tree, by `spack dev-build` or `spack develop` (docs/packaging.md).
    """

    license("MIT")

    version("0.1.0")

    variant("tests", default=False, description="Build the test suite")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("node-js@18:", type="build")
    depends_on("npm", type="build")
    depends_on("googletest@1.12: +gmock", type="build", when="+tests")

    depends_on("mpi")
    depends_on("petsc@3.18 +mpi +double ~complex ~int64 +mumps")
    depends_on("slepc@3.18")
    depends_on("hdf5@1.10: +mpi")
    depends_on("boost@1.74: +serialization")
    depends_on("eigen@3.4:3")
    depends_on("fftw@3.3:")
    depends_on("flint@3:")
    depends_on("mpfr@4:")
    depends_on("gmp@6:")
    depends_on("fmt@9:10 +shared")
    depends_on("spdlog@1.10: +shared")
    depends_on("yaml-cpp@0.7: +shared")
    depends_on("cli11@2.1:")
    depends_on("zlib-api")
    depends_on("gnuplot", type="run")

    conflicts("%gcc@:11", msg="Orbweaver is written in C++20 as g++ 12 and later know it")

    generator("ninja")

    def cmake_args(self):
        # Spack's compiler wrapper sets the processor (target=...) for the libraries and the program alike.
        return [
            self.define("ORBWEAVER_NATIVE", False),
            self.define("ORBWEAVER_UNITY_BUILD", True),
            self.define("ORBWEAVER_WARNINGS_AS_ERRORS", False),
            self.define_from_variant("ORBWEAVER_BUILD_TESTS", "tests"),
        ]
