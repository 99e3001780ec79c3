# find_package(fleetmap) defines a target for each library, such as fleetmap::graph.
include(${CMAKE_CURRENT_LIST_DIR}/Dependencies.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/fleetmapTargets.cmake)
