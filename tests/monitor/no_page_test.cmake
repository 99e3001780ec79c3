# Without npm the page's part of the build leaves the page out, says so and gives the program the reason.
#   cmake -DSOURCE=... -DWORK=... -P no_page_test.cmake
# It is configured alone: the rest of the build would take minutes and has no part in it.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
file(COPY ${SOURCE}/src/monitor/page.cmake ${SOURCE}/src/monitor/no_page.cpp.in ${SOURCE}/src/monitor/page
     DESTINATION ${WORK}/source)
file(WRITE ${WORK}/source/CMakeLists.txt "
cmake_minimum_required(VERSION 3.25)
project(page_alone LANGUAGES NONE)
include(page.cmake)
file(WRITE ${WORK}/chosen \"\${FLEETMAP_MONITOR_PAGE_SOURCE}\")
")

# Configures with further arguments; sets `said` and `source`, the text of the file that is compiled in place of the page.
function(configure_page)
  file(REMOVE_RECURSE ${WORK}/build)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK}/source -B ${WORK}/build -DCMAKE_MAKE_PROGRAM=/bin/true ${ARGN}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE all ERROR_VARIABLE all)
  if(failed)
    message(FATAL_ERROR "${ARGN}: the build cannot be configured:\n${all}")
  endif()
  string(REGEX REPLACE "[ \n]+" " " all "${all}")
  file(READ ${WORK}/chosen chosen)
  if(NOT EXISTS ${chosen})
    message(FATAL_ERROR "${ARGN}: there is no ${chosen} to compile")
  endif()
  file(READ ${chosen} text)
  set(said "${all}" PARENT_SCOPE)
  set(source "${text}" PARENT_SCOPE)
endfunction()

function(expect_no_page because)
  configure_page(${ARGN})
  if(NOT said MATCHES "fleetmap is built without the page of `fleetmap monitor`: ${because}")
    message(FATAL_ERROR "${ARGN}: \"${because}\" is not said, but\n${said}")
  endif()
  if(NOT source MATCHES "This program was built without the monitor's page: ${because}")
    message(FATAL_ERROR "${ARGN}: the program does not say \"${because}\":\n${source}")
  endif()
  set(said "${said}" PARENT_SCOPE)
endfunction()

expect_no_page("npm was not found; install it and configure again"
               -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF)
# An npm that fails, as one without a network does.
file(WRITE ${WORK}/failing_npm "#!/bin/sh\necho no network >&2\nexit 1\n")
file(CHMOD ${WORK}/failing_npm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
expect_no_page("npm could not install its packages" -DNPM_PROGRAM=${WORK}/failing_npm -DNODE_PROGRAM=/bin/true)
if(NOT said MATCHES "npm: no network")
  message(FATAL_ERROR "npm's own words are not repeated:\n${said}")
endif()
expect_no_page("it was configured with FLEETMAP_MONITOR_PAGE=OFF" -DFLEETMAP_MONITOR_PAGE=OFF)
