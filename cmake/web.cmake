# For the page in the browser: what dependencies.cmake takes from Debian, compiled by emscripten. Header-only libraries
# are reached through links of their own, because all of /usr/include is made for another machine.
set(libraries ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${libraries})
foreach(library fmt nlohmann)
  file(CREATE_LINK /usr/include/${library} ${libraries}/${library} SYMBOLIC)
endforeach()

add_library(fmt INTERFACE)
add_library(fmt::fmt ALIAS fmt)
target_include_directories(fmt SYSTEM INTERFACE ${libraries})
target_compile_definitions(fmt INTERFACE FMT_HEADER_ONLY)

add_library(nlohmann_json INTERFACE)
add_library(nlohmann_json::nlohmann_json ALIAS nlohmann_json)
target_include_directories(nlohmann_json SYSTEM INTERFACE ${libraries})

# The source of the very library that the program uses: tools/yaml_source.sh.
set(yaml ${PROJECT_SOURCE_DIR}/build/yaml-cpp)
if(NOT EXISTS ${yaml}/src/parser.cpp)
  message(FATAL_ERROR "no source of yaml-cpp in ${yaml}: run tools/setup.sh web")
endif()
file(GLOB yaml_sources ${yaml}/src/*.cpp)
add_library(yaml-cpp STATIC ${yaml_sources})
target_include_directories(yaml-cpp SYSTEM PUBLIC ${yaml}/include)
target_compile_definitions(yaml-cpp PUBLIC YAML_CPP_STATIC_DEFINE)
set_target_properties(yaml-cpp PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 40)
