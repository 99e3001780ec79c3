# Everything comes from Debian 12; deploy/install-dependencies.sh names the packages.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(tl-expected REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(LibLZMA REQUIRED)
find_package(fastcdr REQUIRED)
find_package(fastrtps REQUIRED)
find_package(embree 3 REQUIRED)
find_package(PNG REQUIRED)

# GeographicLib and Draco install CMake files that Debian's layout does not let
# find_package see without help, so their libraries are looked up directly.
find_path(GEOGRAPHICLIB_INCLUDE_DIR GeographicLib/LocalCartesian.hpp REQUIRED)
find_library(GEOGRAPHICLIB_LIBRARY NAMES GeographicLib Geographic REQUIRED)
add_library(GeographicLib INTERFACE IMPORTED)
target_include_directories(GeographicLib SYSTEM INTERFACE ${GEOGRAPHICLIB_INCLUDE_DIR})
target_link_libraries(GeographicLib INTERFACE ${GEOGRAPHICLIB_LIBRARY})

find_path(DRACO_INCLUDE_DIR draco/compression/encode.h REQUIRED)
find_library(DRACO_LIBRARY NAMES draco REQUIRED)
add_library(Draco INTERFACE IMPORTED)
target_include_directories(Draco SYSTEM INTERFACE ${DRACO_INCLUDE_DIR})
target_link_libraries(Draco INTERFACE ${DRACO_LIBRARY})

# PCL's own package file pulls in VTK and Qt, which cost minutes and are of no use here, so only the components that are
# needed are looked up.
find_path(PCL_INCLUDE_DIR pcl/point_types.h PATH_SUFFIXES pcl-1.13 REQUIRED)
function(fleetmap_find_pcl component)
  find_library(PCL_${component}_LIBRARY pcl_${component} REQUIRED)
  add_library(Pcl::${component} INTERFACE IMPORTED GLOBAL)
  target_include_directories(Pcl::${component} SYSTEM INTERFACE ${PCL_INCLUDE_DIR})
  target_link_libraries(Pcl::${component} INTERFACE ${PCL_${component}_LIBRARY} Eigen3::Eigen ${ARGN})
endfunction()
fleetmap_find_pcl(common)
# For a file that is compiled with PCL_NO_PRECOMPILE: PCL's other libraries are 28 MB in memory. FLANN needs LZ4.
find_library(LZ4_LIBRARY lz4 REQUIRED)
add_library(Pcl::compiled_in INTERFACE IMPORTED GLOBAL)
target_link_libraries(Pcl::compiled_in INTERFACE Pcl::common ${LZ4_LIBRARY})

if(FLEETMAP_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
  # The yardstick of the tests and benchmarks.
  fleetmap_find_pcl(kdtree Pcl::common)
  fleetmap_find_pcl(search Pcl::kdtree)
  fleetmap_find_pcl(features Pcl::search)
  fleetmap_find_pcl(sample_consensus Pcl::search)
  fleetmap_find_pcl(registration Pcl::features Pcl::sample_consensus)
  fleetmap_find_pcl(io Pcl::common)
  fleetmap_find_pcl(filters Pcl::search)
endif()
