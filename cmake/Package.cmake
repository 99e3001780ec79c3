# `cmake --install` and `cpack` (deploy/package.sh) make the packages fleetmap, the program with its QoS profiles and what
# runs it as a service; fleetmap-twin, the worlds and fleets to simulate and the library that casts their rays;
# fleetmap-gis, which links GDAL; and fleetmap-dev, the libraries for programs of others.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package ${PROJECT_SOURCE_DIR}/deploy/package)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME fleetmap)
install(TARGETS fleetmap RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY qos DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap)
install(DIRECTORY config/agents config/robots config/rviz config/sensors config/sites
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap/config)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY docs/reference DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(FILES ${package}/fleetmap-agent@.service DESTINATION lib/systemd/system)
install(FILES ${package}/sysctl.conf DESTINATION lib/sysctl.d RENAME 00-fleetmap.conf)
install(FILES ${package}/sysusers.conf DESTINATION lib/sysusers.d RENAME fleetmap.conf)
install(DIRECTORY DESTINATION /etc/fleetmap)
install(FILES ${PROJECT_BINARY_DIR}/fleetmap.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
install(FILES ${PROJECT_BINARY_DIR}/fleetmap.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME fleetmap OPTIONAL)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME twin)
install(DIRECTORY config/experiments config/fleets config/trials config/worlds
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap/config)
install(DIRECTORY deploy/netns DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap/deploy USE_SOURCE_PERMISSIONS)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fleetmap-twin RENAME copyright)

set(packages fleetmap twin dev)
if(TARGET fleetmap_geotiff)
  list(APPEND packages gis)
  install(TARGETS fleetmap_geotiff LIBRARY DESTINATION lib/fleetmap COMPONENT gis)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fleetmap-gis RENAME copyright COMPONENT gis)
endif()

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
set(fleetmap_cmake ${CMAKE_INSTALL_LIBDIR}/cmake/fleetmap)
install(DIRECTORY include/fleetmap DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY idl/fleetmap DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap/idl FILES_MATCHING PATTERN *.idl)
install(DIRECTORY idl/ros2 DESTINATION ${CMAKE_INSTALL_DATADIR}/fleetmap/idl FILES_MATCHING PATTERN *.idl)
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/generated/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fleetmap/idl
        FILES_MATCHING PATTERN *.h PATTERN *PubSubTypes.h EXCLUDE)
install(EXPORT fleetmap NAMESPACE fleetmap:: FILE fleetmapTargets.cmake DESTINATION ${fleetmap_cmake})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fleetmapConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES ${package}/fleetmapConfig.cmake ${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake
              ${PROJECT_BINARY_DIR}/fleetmapConfigVersion.cmake DESTINATION ${fleetmap_cmake})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fleetmap-dev RENAME copyright)

# Each commit's package is newer than that of the commit before, or apt would not install it over that one.
execute_process(COMMAND ${CMAKE_COMMAND} -E env TZ=UTC git -c safe.directory=* log -1 --date=format-local:%Y%m%d%H%M%S
                        "--format=+git%cd.%h" WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -c safe.directory=* diff --quiet HEAD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                RESULT_VARIABLE changed ERROR_QUIET)
if(commit AND changed)
  string(TIMESTAMP now "%Y%m%d%H%M%S" UTC)
  string(APPEND commit ".changed${now}")
endif()
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION}${commit})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "fleetmap <fleetmap@localhost>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL ${packages})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(CPACK_COMPONENT_FLEETMAP_DESCRIPTION "ground robots map a large outdoor site together, without a server")
set(CPACK_DEBIAN_FLEETMAP_PACKAGE_NAME fleetmap)
set(CPACK_DEBIAN_FLEETMAP_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FLEETMAP_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FLEETMAP_PACKAGE_CONTROL_EXTRA ${package}/postinst ${package}/prerm ${package}/postrm)

set(same_version "fleetmap (= ${CPACK_PACKAGE_VERSION})")
set(CPACK_COMPONENT_TWIN_DESCRIPTION "worlds and fleets that fleetmap simulates, and trials on network interfaces")
set(CPACK_DEBIAN_TWIN_PACKAGE_NAME fleetmap-twin)
set(CPACK_DEBIAN_TWIN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TWIN_PACKAGE_DEPENDS "${same_version}, libembree3-3")
set(CPACK_DEBIAN_TWIN_PACKAGE_RECOMMENDS "iproute2, python3")  # `trial`

set(CPACK_COMPONENT_GIS_DESCRIPTION "writes maps of fleetmap as GeoTIFF")
set(CPACK_DEBIAN_GIS_PACKAGE_NAME fleetmap-gis)
set(CPACK_DEBIAN_GIS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_GIS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_GIS_PACKAGE_DEPENDS "${same_version}")

# Static libraries name what they need; the same list as deploy/install-dependencies.sh has.
set(CPACK_COMPONENT_DEV_DESCRIPTION "libraries, headers and IDL of fleetmap, for programs of others")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME fleetmap-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
       libeigen3-dev libexpected-dev libspdlog-dev libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libsqlite3-dev
       libssl-dev liblzma-dev libfastcdr-dev libfastrtps-dev libtinyxml2-dev libembree-dev libpng-dev zlib1g-dev
       libbz2-dev libgeographiclib-dev libdraco-dev libsleef-dev liblz4-dev libzstd-dev libsystemd-dev libpcl-dev)
include(CPack)
