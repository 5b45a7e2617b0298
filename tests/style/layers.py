#!/usr/bin/python3
"""Checks the dependencies of modules: the module's line in lib/CMakeLists.txt must allow every #include. Kernels must be in
the namespace of their instruction set.

Usage: layers.py <source directory>
"""
import pathlib
import re
import sys

# Libraries and patterns of their headers. Every module may include Eigen and the standard library.
OWNERS = {
    "BOOST": r"boost/.+",
    "METIS": r"metis\.h",
    "YAML": r"yaml-cpp/.+",
    "HDF5": r"(hdf5|H5\w+)\.h",
    "TEUCHOS": r"Teuchos_\w+\.hpp",
    "TRILINOS": r"(Teuchos|Tpetra|Belos|Anasazi|Amesos2?|NOX|Thyra|Stratimikos|Kokkos|Xpetra|Ifpack2|MueLu|Teko|Piro)\w*\.(hpp|H)",
    "THYRA": r"(Thyra|NOX|Stratimikos)\w*\.(hpp|H)",
    "MPI": r"mpi\.h",
}
# Libraries that include others.
BRINGS = {"TRILINOS": {"TRILINOS", "THYRA", "TEUCHOS", "MPI"}, "HDF5": {"HDF5", "MPI"}}
# Only this file of a module may include the library: {(module, library): file}.
ONLY_IN = {("membrane", "TRILINOS"): "direct_solver.cpp", ("system", "THYRA"): "nonlinear.cpp"}


def allowed(source):
    """Returns {module: (modules, libraries) that it may use}."""
    modules = {}
    for line in (source / "lib/CMakeLists.txt").read_text().splitlines():
        match = re.fullmatch(r"module\(([\w/]+)(?: +USES +([a-z/ ]+?))?(?: +EXTERNAL +([A-Z0-9 ]+?))? *\)", line.strip())
        if match:
            name, uses, external = match.groups()
            libraries = set((external or "").split())
            for library in set(libraries):
                libraries |= BRINGS.get(library, set())
            modules[name] = ({name, *(uses or "").split()}, libraries)
        elif line.startswith("module("):
            sys.exit(f"lib/CMakeLists.txt: not understood: {line}")
    return modules


def order_errors(modules):
    """Yields errors of lib/CMakeLists.txt: a module may use only modules listed above it; stokes and membrane may not use each other."""
    names = list(modules)
    for position, name in enumerate(names):
        for used in modules[name][0] - {name}:
            if used not in names[:position]:
                yield f"lib/CMakeLists.txt: {name} uses {used}, which does not stand above it"
    for name, other in (("stokes", "membrane"), ("membrane", "stokes")):
        if other in modules[name][0]:
            yield f"lib/CMakeLists.txt: {name} may not see {other}"


def module_of(name, modules):
    """Returns the module of a file in lib/: the innermost of its folders that has a line in lib/CMakeLists.txt."""
    return next((folder.as_posix() for folder in pathlib.PurePath(name).parents if folder.as_posix() in modules), None)


def include_errors(source, modules):
    for path in sorted((source / "lib").rglob("*.[ch]pp")):
        module = module_of(path.relative_to(source / "lib"), modules)
        if module is None:
            yield f"{path}: lib/CMakeLists.txt has no line for this module"
            continue
        uses, libraries = modules[module]
        for header in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(), re.MULTILINE):
            foreign = header.split("/")[0] in ("Eigen", "unsupported", "sys", "boost", "yaml-cpp")
            if "/" in header and not foreign and module_of(header, modules) not in uses:
                yield f"{path}: {module} may not include {header}"
            owners = {owner for owner, pattern in OWNERS.items() if re.fullmatch(pattern, header)}
            if owners and not owners & libraries:
                yield f"{path}: {module} may not include {header}, of {'/'.join(sorted(owners))}"
            for owner in owners:
                if path.name != ONLY_IN.get((module, owner), path.name):
                    yield f"{path}: in {module} only {ONLY_IN[module, owner]} may include {header}"


def kernel_errors(source):
    """Yields kernel files whose functions are not in the namespace of their instruction set. Several instruction sets
    define functions of the same name. In one namespace, the linker would choose one of them arbitrarily."""
    for path in sorted((source / "lib").rglob("*_kernel.cpp")):
        if not re.search(r"^(inline )?namespace (\w+::)*INSTRUCTIONS {$", path.read_text(), re.MULTILINE):
            yield f"{path}: a file *_kernel.cpp has its functions in the namespace INSTRUCTIONS (base/kernel.hpp)"


def main():
    source = pathlib.Path(sys.argv[1])
    modules = allowed(source)
    errors = [*order_errors(modules), *include_errors(source, modules), *kernel_errors(source)]
    print("\n".join(errors))
    sys.exit(bool(errors))


if __name__ == "__main__":
    main()
