include(GoogleTest OPTIONAL)

add_library(fleetmap_flags INTERFACE)
target_compile_options(fleetmap_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion)
if(NOT FLEETMAP_SANITIZE)  # GCC warns of uninitialised values in code that a sanitizer has rewritten
  target_compile_options(fleetmap_flags INTERFACE -Werror)
endif()

if(FLEETMAP_SANITIZE)
  add_compile_options(-fsanitize=${FLEETMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FLEETMAP_SANITIZE})
endif()

# fleetmap_library(place SOURCES a.cpp b.cpp PUBLIC fleetmap::geometry PRIVATE Draco)
# makes target fleetmap_place, alias fleetmap::place, with headers in include/fleetmap/place.
function(fleetmap_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(fleetmap_${name} STATIC ${ARG_SOURCES})
  add_library(fleetmap::${name} ALIAS fleetmap_${name})
  target_include_directories(fleetmap_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(fleetmap_${name} PUBLIC ${ARG_PUBLIC} PRIVATE fleetmap_flags ${ARG_PRIVATE})
endfunction()

# fleetmap_test(place SOURCES ball_tree_test.cpp LINK fleetmap::place) makes one test program
# test_place; ctest lists its cases one by one, with the label "unit" unless LABEL says otherwise.
function(fleetmap_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  # Integration tests keep real time or all cores busy.
  string(COMPARE EQUAL "${ARG_LABEL}" integration serial)
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
    if(FLEETMAP_SANITIZE)
      set(ARG_TIMEOUT 1200)
    endif()
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  if(FLEETMAP_SANITIZE AND serial)  # only unit tests run sanitised; the others are built when asked for
    set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE FLEETMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                  FLEETMAP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(test_${name} PRIVATE fleetmap_flags ${ARG_LINK} GTest::gmock GTest::gtest_main)
  gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${serial})
endfunction()

# fleetmap_bench(place SOURCES bench/ball_tree_bench.cpp LINK fleetmap::place) makes bench_place.
function(fleetmap_bench name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(bench_${name} ${ARG_SOURCES})
  target_include_directories(bench_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(bench_${name} PRIVATE fleetmap_flags ${ARG_LINK} benchmark::benchmark_main)
endfunction()
