# The libraries of others, each as one target external_<NAME>; their headers are SYSTEM, so that their warnings stay theirs.

find_package(Eigen3 REQUIRED NO_MODULE)
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Trilinos REQUIRED)
set(HDF5_USE_STATIC_LIBRARIES ON) # the shared one loads thirty libraries for files in clouds
find_package(HDF5 REQUIRED COMPONENTS C)
find_path(BOOST_MATH_INCLUDE_DIR boost/math/special_functions.hpp REQUIRED)
find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)
find_path(YAML_INCLUDE_DIR yaml-cpp/yaml.h REQUIRED)
find_library(YAML_LIBRARY yaml-cpp REQUIRED)
find_path(UDUNITS_INCLUDE_DIR udunits2.h REQUIRED)
find_library(UDUNITS_LIBRARY udunits2 REQUIRED)

function(external name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;LIBRARIES")
  add_library(external_${name} INTERFACE)
  set_property(GLOBAL APPEND PROPERTY externals ${name})
  target_include_directories(external_${name} SYSTEM INTERFACE ${arg_HEADERS})
  target_link_libraries(external_${name} INTERFACE ${arg_LIBRARIES})
endfunction()

set(teuchos teuchosparameterlist teuchosparser teuchoscomm teuchosnumerics teuchoscore)
list(TRANSFORM teuchos PREPEND trilinos_)
foreach(name nox amesos2 stratimikosbelos belos thyratpetra thyracore tpetra kokkoscore) # as files: their targets list all of Trilinos, and the shared HDF5
  find_library(TRILINOS_${name} trilinos_${name} HINTS ${Trilinos_LIBRARY_DIRS} REQUIRED)
  list(APPEND trilinos ${TRILINOS_${name}})
endforeach()

external(BOOST HEADERS ${BOOST_MATH_INCLUDE_DIR})
external(METIS HEADERS ${METIS_INCLUDE_DIR} LIBRARIES ${METIS_LIBRARY})
external(YAML HEADERS ${YAML_INCLUDE_DIR} LIBRARIES ${YAML_LIBRARY})
external(UDUNITS HEADERS ${UDUNITS_INCLUDE_DIR} LIBRARIES ${UDUNITS_LIBRARY})
external(HDF5 HEADERS ${HDF5_INCLUDE_DIRS} LIBRARIES ${HDF5_LIBRARIES} MPI::MPI_CXX)
external(TEUCHOS HEADERS ${Trilinos_INCLUDE_DIRS} ${Trilinos_TPL_INCLUDE_DIRS} LIBRARIES ${teuchos} MPI::MPI_CXX)
external(TRILINOS
  HEADERS ${Trilinos_INCLUDE_DIRS} ${Trilinos_TPL_INCLUDE_DIRS}
  LIBRARIES ${trilinos} ${teuchos} MPI::MPI_CXX)
