# The page of `fleetmap monitor`: TypeScript that esbuild bundles with npm packages, compiled into the program. Its packages
# are installed when the build is configured, so that a machine without npm or without a network hears of it at once.
# Sets FLEETMAP_MONITOR_PAGE_SOURCE, FLEETMAP_MONITOR_PAGE_FOLDER (with node_modules) and FLEETMAP_NO_PAGE, the reason why there is no page.
option(FLEETMAP_MONITOR_PAGE "Build the page of `fleetmap monitor`, which needs npm and its registry" ON)
set(page_source ${CMAKE_CURRENT_SOURCE_DIR}/page)
set(FLEETMAP_MONITOR_PAGE_FOLDER ${PROJECT_BINARY_DIR}/monitor_page)
set(FLEETMAP_NO_PAGE "")
find_program(NPM_PROGRAM npm)
find_program(NODE_PROGRAM NAMES node nodejs)
if(NOT FLEETMAP_MONITOR_PAGE)
  set(FLEETMAP_NO_PAGE "it was configured with FLEETMAP_MONITOR_PAGE=OFF")
elseif(FLEETMAP_SANITIZE)
  set(FLEETMAP_NO_PAGE "builds with sanitizers leave it out")
elseif(NOT NPM_PROGRAM OR NOT NODE_PROGRAM)
  set(FLEETMAP_NO_PAGE "npm was not found; install it and configure again")
else()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_source}/package.json ${page_source}/package-lock.json)
  file(SHA256 ${page_source}/package-lock.json wanted)
  set(installed "")
  if(EXISTS ${FLEETMAP_MONITOR_PAGE_FOLDER}/installed)
    file(READ ${FLEETMAP_MONITOR_PAGE_FOLDER}/installed installed)
  endif()
  if(NOT installed STREQUAL wanted)
    message(STATUS "installing the packages of the monitor's page (npm)")
    file(COPY ${page_source}/package.json ${page_source}/package-lock.json DESTINATION ${FLEETMAP_MONITOR_PAGE_FOLDER})
    execute_process(COMMAND ${NPM_PROGRAM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 --fetch-timeout=20000
                    WORKING_DIRECTORY ${FLEETMAP_MONITOR_PAGE_FOLDER} TIMEOUT 300
                    RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(failed)
      set(FLEETMAP_NO_PAGE "npm could not install its packages (no network?); configure again where it can")
      message(STATUS "npm: ${said}")
    else()
      file(WRITE ${FLEETMAP_MONITOR_PAGE_FOLDER}/installed ${wanted})
    endif()
  endif()
endif()

if(FLEETMAP_NO_PAGE)
  set(FLEETMAP_MONITOR_PAGE_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/no_page.cpp)
  configure_file(no_page.cpp.in ${FLEETMAP_MONITOR_PAGE_SOURCE} @ONLY)
  if(NOT FLEETMAP_SANITIZE)
    message(WARNING "fleetmap is built without the page of `fleetmap monitor`: ${FLEETMAP_NO_PAGE}")
  endif()
else()
  set(FLEETMAP_MONITOR_PAGE_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/page_files.cpp)
  file(GLOB page_files CONFIGURE_DEPENDS ${page_source}/*)
  add_custom_command(
    OUTPUT ${FLEETMAP_MONITOR_PAGE_SOURCE} DEPENDS ${page_files}
    COMMAND ${CMAKE_COMMAND} -E copy ${page_files} ${FLEETMAP_MONITOR_PAGE_FOLDER}
    COMMAND ${CMAKE_COMMAND} -E chdir ${FLEETMAP_MONITOR_PAGE_FOLDER} ${NODE_PROGRAM} build.mjs ${FLEETMAP_MONITOR_PAGE_SOURCE}
    COMMENT "Bundling the page of fleetmap monitor" VERBATIM)
endif()
# For tests/monitor, which is no folder below this one.
set(FLEETMAP_NO_PAGE "${FLEETMAP_NO_PAGE}" CACHE INTERNAL "Why fleetmap monitor has no page; empty: it has")
set(FLEETMAP_MONITOR_PAGE_FOLDER ${FLEETMAP_MONITOR_PAGE_FOLDER} CACHE INTERNAL "Where the page is bundled")
