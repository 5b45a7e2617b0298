# The libraries of others, each as one target external_<NAME>; their headers are SYSTEM, so that their warnings stay theirs. Headers and libraries are
# found as files on every system: the variables of Trilinos and the modes of FindHDF5 differ from version to version.

find_package(Eigen3 REQUIRED NO_MODULE)
find_package(MPI REQUIRED COMPONENTS CXX)
find_path(TRILINOS_INCLUDE_DIR Tpetra_Core.hpp PATH_SUFFIXES trilinos REQUIRED)
find_path(KOKKOS_INCLUDE_DIR Kokkos_Core.hpp PATH_SUFFIXES trilinos kokkos REQUIRED)
find_path(HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/openmpi REQUIRED)
find_library(HDF5_LIBRARY NAMES libhdf5.a hdf5 PATH_SUFFIXES hdf5/openmpi REQUIRED) # the shared one loads thirty libraries for files in clouds
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

foreach(name teuchosparameterlist teuchosparser teuchoscomm teuchosnumerics teuchoscore
    nox amesos2 stratimikosbelos belos thyratpetra thyracore tpetra kokkoscore)
  find_library(TRILINOS_${name} NAMES trilinos_${name} ${name} REQUIRED)
  if(name MATCHES teuchos)
    list(APPEND teuchos ${TRILINOS_${name}})
  else()
    list(APPEND trilinos ${TRILINOS_${name}})
  endif()
endforeach()

external(BOOST HEADERS ${BOOST_MATH_INCLUDE_DIR})
external(METIS HEADERS ${METIS_INCLUDE_DIR} LIBRARIES ${METIS_LIBRARY})
external(YAML HEADERS ${YAML_INCLUDE_DIR} LIBRARIES ${YAML_LIBRARY})
external(UDUNITS HEADERS ${UDUNITS_INCLUDE_DIR} LIBRARIES ${UDUNITS_LIBRARY})
external(HDF5 HEADERS ${HDF5_INCLUDE_DIR} LIBRARIES ${HDF5_LIBRARY} sz z m dl MPI::MPI_CXX)
external(TEUCHOS HEADERS ${TRILINOS_INCLUDE_DIR} ${KOKKOS_INCLUDE_DIR} LIBRARIES ${teuchos} MPI::MPI_CXX)
external(TRILINOS HEADERS ${TRILINOS_INCLUDE_DIR} ${KOKKOS_INCLUDE_DIR} LIBRARIES ${trilinos} ${teuchos} MPI::MPI_CXX)
