# find_package(tanktread): the modules of the library, tanktread::base to tanktread::record, and the program, tanktread::app, which links all of
# them.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
find_dependency(MPI COMPONENTS CXX)
include(${CMAKE_CURRENT_LIST_DIR}/tanktread-targets.cmake)
