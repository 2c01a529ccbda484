# Libraries for other programs: gpo::core, gpo::frontend, gpo::recording, gpo::inspection. Each is one library,
# static or with BUILD_SHARED_LIBS shared, made from the object files of its modules.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# <gpo/initialize.h> here as where it is installed.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/gpo SYMBOLIC)
set(GPO_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gpo)
set(GPO_MODULES ${CMAKE_CURRENT_SOURCE_DIR}/cmake)

# gpo_component(NAME ROOMS room... HEADERS public... PUBLIC link... PRIVATE link...)
function(gpo_component name)
  if(NOT GPO_LIBRARY)
    return()
  endif()
  cmake_parse_arguments(of "" "" "ROOMS;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(objects)
  foreach(room ${of_ROOMS})
    list(APPEND objects $<TARGET_OBJECTS:gpo_${room}>)
  endforeach()
  # Shared libraries do not offer each other what is outside of namespace gpo.
  if(NOT name STREQUAL "core")
    list(APPEND objects $<FILTER:$<TARGET_OBJECTS:gpo_base>,INCLUDE,compiled_once>)
  endif()
  set(target gpo_component_${name})
  add_library(${target} ${objects})
  add_library(gpo::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME gpo_${name} EXPORT_NAME ${name} LINKER_LANGUAGE CXX
    ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PUBLIC "$<$<COMPILE_LANGUAGE:CXX>:${GPO_EIGEN_LAYOUT}>")
  target_link_libraries(${target} PUBLIC ${of_PUBLIC} PRIVATE ${of_PRIVATE})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL SHARED_LIBRARY)
    set(symbols ${GPO_MODULES}/symbols.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${symbols} LINKER:--no-undefined)
    # Installed together, wherever that is, they find each other.
    set_target_properties(${target} PROPERTIES LINK_DEPENDS ${symbols} INSTALL_RPATH $ORIGIN)
  endif()
  if(NOT PROJECT_IS_TOP_LEVEL)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()

  install(TARGETS ${target} EXPORT gpo-${name}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT gpo-${name} NAMESPACE gpo:: DESTINATION ${GPO_PACKAGE_DIR} COMPONENT development)
  install(CODE "set(GPO_FROM \"${CMAKE_CURRENT_SOURCE_DIR}\")
    set(GPO_TO \"${CMAKE_INSTALL_INCLUDEDIR}/gpo\")
    set(GPO_HEADERS ${of_HEADERS})
    include(\"${GPO_MODULES}/install_headers.cmake\")" COMPONENT development)
endfunction()

if(GPO_LIBRARY AND PROJECT_IS_TOP_LEVEL)
  set(package ${PROJECT_BINARY_DIR}/package)
  configure_package_config_file(${GPO_MODULES}/gpoConfig.cmake.in ${package}/gpoConfig.cmake
    INSTALL_DESTINATION ${GPO_PACKAGE_DIR})
  # For pkg-config: core and frontend, the static ones with the libraries that they need.
  list(JOIN GPO_EIGEN_LAYOUT " " layout)
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  set(libraries -lgpo_core)
  set(static_libraries "-lceres -lglog")
  if("frontend" IN_LIST GPO_COMPONENTS)
    set(libraries "-lgpo_frontend ${libraries}")
    string(PREPEND static_libraries "-lopencv_calib3d -lopencv_features2d -lopencv_video -lopencv_imgproc -lopencv_core -lopengv ")
  endif()
  if(NOT BUILD_SHARED_LIBS)
    string(APPEND libraries " ${static_libraries}")
  endif()
  configure_file(${GPO_MODULES}/gpo.pc.in ${package}/gpo.pc @ONLY)
  install(FILES ${package}/gpo.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
  write_basic_package_version_file(${package}/gpoConfigVersion.cmake COMPATIBILITY SameMajorVersion)
  install(FILES ${package}/gpoConfig.cmake ${package}/gpoConfigVersion.cmake
    DESTINATION ${GPO_PACKAGE_DIR} COMPONENT development)
endif()
