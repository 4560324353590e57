# Compiler settings shared by every target of the project.
add_library(wunderlich_options INTERFACE)
target_compile_features(wunderlich_options INTERFACE cxx_std_20)

# Release keeps our own asserts (no NDEBUG: they cost nothing measurable and a wrong result costs more);
# Eigen's index checks in the inner loops are left to the other build types.
set(CMAKE_CXX_FLAGS_RELEASE "-O3")
target_compile_definitions(wunderlich_options INTERFACE $<$<CONFIG:Release>:EIGEN_NO_DEBUG>)

# The two flags let the compiler keep sqrt and log inline; results do not change. Never -ffast-math.
target_compile_options(wunderlich_options INTERFACE
  -Wall -Wextra -Wpedantic -fno-math-errno -fno-trapping-math)
if(NOT CMAKE_UNITY_BUILD)
  target_compile_options(wunderlich_options INTERFACE -Wshadow)
else()  # where several files are compiled as one, a local variable may be named like a constant of another file
  target_compile_options(wunderlich_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endif()
if(WUNDERLICH_NATIVE)
  # Vectors of eight are of no use here. Eigen's own vector code stays out: at AVX's width g++ 12 takes parts of it for
  # uninitialised or out of bounds, and what runs often is in math/four.hpp.
  target_compile_options(wunderlich_options INTERFACE -march=native)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(wunderlich_options INTERFACE -mno-avx512f)
  endif()
  target_compile_definitions(wunderlich_options INTERFACE EIGEN_DONT_VECTORIZE)
endif()
if(WUNDERLICH_WEB)
  # Wasm's own exceptions cost nothing until one is thrown; every browser of 2022 or later has both.
  add_compile_options(-msimd128 -fwasm-exceptions)
  add_link_options(-fwasm-exceptions)
  target_compile_definitions(wunderlich_options INTERFACE EIGEN_DONT_VECTORIZE)  # it does not know these vectors
endif()
# Vectors of four are passed to inline functions only; what their calling convention would be does not matter.
target_compile_options(wunderlich_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
if(WUNDERLICH_WARNINGS_AS_ERRORS)
  target_compile_options(wunderlich_options INTERFACE -Werror)
endif()

set(WUNDERLICH_SANITIZE_SKIP "" CACHE STRING "Undefined-behaviour checks to leave out, separated by commas")
if(WUNDERLICH_SANITIZE)
  target_compile_options(wunderlich_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    # Instrumented code of the standard library's <regex> sets off false alarms of g++ 12.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(wunderlich_options INTERFACE -fsanitize=address,undefined)
  target_compile_definitions(wunderlich_options INTERFACE _GLIBCXX_ASSERTIONS)
  if(WUNDERLICH_SANITIZE_SKIP)
    target_compile_options(wunderlich_options INTERFACE -fno-sanitize=${WUNDERLICH_SANITIZE_SKIP})
  endif()
endif()
if(WUNDERLICH_COVERAGE)
  target_compile_options(wunderlich_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(wunderlich_options INTERFACE --coverage)
endif()
