include(GNUInstallDirs)
include(GoogleTest OPTIONAL)

# All robots must compute the same numbers from the same items. GCC fuses a * b + c into one rounding where the
# processor can: on ARM, but not on x86-64 as Debian compiles for it.
add_compile_options(-ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  add_compile_options(-U__ARM_FEATURE_FMA)  # by which Eigen's vector code fuses them as well
endif()

add_library(fleetmap_flags INTERFACE)
target_compile_options(fleetmap_flags INTERFACE -Wall -Wextra -Wpedantic -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # It collects garbage only beyond 600 MB, which few files reach: a sixth of the time to compile.
  add_compile_options("SHELL:--param ggc-min-heapsize=600000")
endif()
if(NOT FLEETMAP_SANITIZE)  # GCC warns of uninitialised values in code that a sanitizer has rewritten
  target_compile_options(fleetmap_flags INTERFACE -Werror)
endif()

if(FLEETMAP_SANITIZE)
  add_compile_options(-fsanitize=${FLEETMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FLEETMAP_SANITIZE})
endif()
if(FLEETMAP_SANITIZE MATCHES "address")
  # Else Eigen allocates in a way of its own under this sanitizer, and PCL, which is built without it, frees what our code
  # allocated.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(FLEETMAP_SANITIZE MATCHES "undefined")
  # Checks of every single pointer and reference, of which Eigen's expressions are made, double the time to build.
  # AddressSanitizer finds what is null or no object at all; misaligned ones are looked for where bytes are read.
  add_compile_options(-fno-sanitize=null,alignment,vptr,object-size,nonnull-attribute,returns-nonnull-attribute,pointer-overflow)
endif()
set(FLEETMAP_READS_BYTES core trust sensor cloud store exchange ros_codec fleet_codec recording bus bus_dds)

# Reading Eigen, gtest and the standard library is most of the work of compiling a small file, so it is done once for
# all libraries and once for all programs (GCC compiles those with other flags). Configure with
# CMAKE_DISABLE_PRECOMPILE_HEADERS=ON to see whether every file names what it includes.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "int main() {}\n")  # written once only
set(FLEETMAP_PRECOMPILED <algorithm> <array> <cmath> <cstdint> <deque> <filesystem> <fstream> <functional> <limits> <map>
                         <memory> <optional> <random> <set> <sstream> <string> <unordered_map> <variant> <vector>
                         <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry> <tl/expected.hpp>)
add_library(fleetmap_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
target_link_libraries(fleetmap_precompiled PRIVATE fleetmap_flags Eigen3::Eigen)
target_precompile_headers(fleetmap_precompiled PRIVATE ${FLEETMAP_PRECOMPILED})
# These libraries calculate little, and clang compiles them unoptimised in half of the time: under sanitizers, where their
# tests take longer by less than that.
set(FLEETMAP_LIBRARIES_UNOPTIMISED "")
if(FLEETMAP_SANITIZE AND NOT FLEETMAP_FUZZ)
  set(FLEETMAP_LIBRARIES_UNOPTIMISED bus_dds config experiment monitor output recording ros_codec ros_output run_evaluation)
  add_library(fleetmap_precompiled_libraries_unoptimised OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(fleetmap_precompiled_libraries_unoptimised PRIVATE fleetmap_flags Eigen3::Eigen)
  target_compile_options(fleetmap_precompiled_libraries_unoptimised PRIVATE -O0)
  target_precompile_headers(fleetmap_precompiled_libraries_unoptimised PRIVATE ${FLEETMAP_PRECOMPILED})
endif()
# A test compiles a third faster with -O1 than as the program is shipped, and unoptimised under sanitizers in less than
# half of the time; these few suites calculate so much themselves that they would lose more than that. Libraries are
# shared under sanitizers and call their own functions: a static one would take the templates that it shares with a
# test from there, unoptimised.
set(FLEETMAP_LIBRARY_KIND STATIC)
set(FLEETMAP_TEST_OPTIONS -O1 -Wno-maybe-uninitialized)  # of which GCC with -O1 finds some that are none
set(FLEETMAP_UNOPTIMISED "")
set(FLEETMAP_CALCULATE_MUCH change fault_injection graph store structure)
if(FLEETMAP_SANITIZE AND NOT FLEETMAP_FUZZ)
  set(FLEETMAP_LIBRARY_KIND SHARED)
  # Tests call what their libraries need for themselves, such as OpenSSL, which static libraries would pass on.
  add_link_options(-Wl,-Bsymbolic-functions -Wl,--copy-dt-needed-entries)
  # A failed test says its line anyway, and without the lines of its callers it compiles a tenth faster.
  set(FLEETMAP_TEST_OPTIONS -g0)
  set(FLEETMAP_UNOPTIMISED -O0)
endif()
function(fleetmap_precompiled_tests name)
  add_executable(${name} ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${name} PRIVATE fleetmap_flags Eigen3::Eigen GTest::gmock)
  target_compile_options(${name} PRIVATE ${FLEETMAP_TEST_OPTIONS} ${ARGN})
  target_precompile_headers(${name} PRIVATE ${FLEETMAP_PRECOMPILED} <gmock/gmock.h> <gtest/gtest.h>)
endfunction()
if(FLEETMAP_TESTS)
  fleetmap_precompiled_tests(fleetmap_precompiled_tests)
  if(FLEETMAP_UNOPTIMISED)
    fleetmap_precompiled_tests(fleetmap_precompiled_unoptimised ${FLEETMAP_UNOPTIMISED})
  endif()
endif()

# Into the package fleetmap-dev, where find_package(fleetmap) knows it as fleetmap::NAME.
function(fleetmap_install_library name)
  set_target_properties(fleetmap_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(fleetmap_${name} PUBLIC cxx_std_20)
  install(TARGETS fleetmap_${name} EXPORT fleetmap DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# Compiles eight files of a target as one, a third faster: for those who build all and change nothing.
function(fleetmap_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${FLEETMAP_UNITY} UNITY_BUILD_BATCH_SIZE 8)
  if(FLEETMAP_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # which takes the eight for headers
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# fleetmap_library(place SOURCES a.cpp b.cpp PUBLIC fleetmap::geometry PRIVATE Draco)
# makes target fleetmap_place, alias fleetmap::place, with headers in include/fleetmap/place.
function(fleetmap_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(fleetmap_${name} ${FLEETMAP_LIBRARY_KIND} ${ARG_SOURCES})
  add_library(fleetmap::${name} ALIAS fleetmap_${name})
  target_include_directories(fleetmap_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>)
  target_link_libraries(fleetmap_${name} PUBLIC ${ARG_PUBLIC} PRIVATE $<BUILD_INTERFACE:fleetmap_flags> ${ARG_PRIVATE})
  fleetmap_install_library(${name})
  if(FLEETMAP_SANITIZE MATCHES "undefined" AND name IN_LIST FLEETMAP_READS_BYTES)
    target_compile_options(fleetmap_${name} PRIVATE -fsanitize=alignment)
  endif()
  if(name IN_LIST FLEETMAP_LIBRARIES_UNOPTIMISED)
    target_compile_options(fleetmap_${name} PRIVATE -O0)
    target_precompile_headers(fleetmap_${name} REUSE_FROM fleetmap_precompiled_libraries_unoptimised)
  else()
    target_precompile_headers(fleetmap_${name} REUSE_FROM fleetmap_precompiled)
  endif()
  fleetmap_unity(fleetmap_${name})
endfunction()

# fleetmap_test(place SOURCES ball_tree_test.cpp LINK fleetmap::place) makes one test program
# test_place; ctest lists its cases one by one (under AddressSanitizer: its suites). LABEL is
#   unit         unless said otherwise: what runs under sanitizers too;
#   drive        whole drives, whose accuracy is measured: minutes under a sanitizer, and shorter ones go the same way;
#   integration  needs the program, or libraries that no sanitizer has been told about.
# Target fleetmap_shipped_tests is all but the unit tests. REAL_TIME are those that other work on the machine would
# disturb: they run alone.
add_custom_target(fleetmap_shipped_tests)
function(fleetmap_test name)
  cmake_parse_arguments(ARG "REAL_TIME" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
    if(FLEETMAP_SANITIZE)
      set(ARG_TIMEOUT 1200)
    endif()
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  if(NOT ARG_LABEL STREQUAL "unit")
    add_dependencies(fleetmap_shipped_tests test_${name})
    if(FLEETMAP_SANITIZE)  # built when asked for
      set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    endif()
  endif()
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${name} PRIVATE FLEETMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                  FLEETMAP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(test_${name} PRIVATE fleetmap_flags ${ARG_LINK} GTest::gmock GTest::gtest_main)
  target_compile_options(test_${name} PRIVATE ${FLEETMAP_TEST_OPTIONS})
  fleetmap_unity(test_${name})
  if(FLEETMAP_UNOPTIMISED AND NOT name IN_LIST FLEETMAP_CALCULATE_MUCH)
    target_compile_options(test_${name} PRIVATE ${FLEETMAP_UNOPTIMISED})
    target_precompile_headers(test_${name} REUSE_FROM fleetmap_precompiled_unoptimised)
  else()
    target_precompile_headers(test_${name} REUSE_FROM fleetmap_precompiled_tests)
  endif()
  if(FLEETMAP_SANITIZE MATCHES "address")
    fleetmap_discover_suites(${name} ${ARG_LABEL} ${ARG_TIMEOUT} ${ARG_REAL_TIME})
  else()
    gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 300
                         PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_REAL_TIME})
  endif()
endfunction()

# Under AddressSanitizer a process takes longer to start than most tests to run, so ctest lists the suites of a program.
function(fleetmap_discover_suites name label timeout real_time)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_suites.cmake)
  add_custom_command(
    TARGET test_${name} POST_BUILD BYPRODUCTS ${list} VERBATIM
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:test_${name}> -D NAME=${name} -D LABEL=${label}
            -D TIMEOUT=${timeout} -D REAL_TIME=${real_time} -D LIST=${list}
            -P ${PROJECT_SOURCE_DIR}/cmake/ListSuites.cmake)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_include.cmake CONTENT
    "if(EXISTS \"${list}\")\n  include(\"${list}\")\nelse()\n  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/test_${name}_include.cmake)
  set_property(TARGET test_${name} APPEND PROPERTY LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/ListSuites.cmake)
endfunction()

# fleetmap_bench(place SOURCES bench/ball_tree_bench.cpp LINK fleetmap::place) makes bench_place.
function(fleetmap_bench name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(bench_${name} ${ARG_SOURCES})
  target_include_directories(bench_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(bench_${name} PRIVATE fleetmap_flags ${ARG_LINK} benchmark::benchmark_main)
endfunction()
