# Compiler settings shared by every target of the project.
add_library(wunderlich_options INTERFACE)
target_compile_features(wunderlich_options INTERFACE cxx_std_20)
# The two flags let the compiler keep sqrt and log inline; results do not change. Never -ffast-math.
target_compile_options(wunderlich_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -fno-math-errno -fno-trapping-math)
if(WUNDERLICH_WARNINGS_AS_ERRORS)
  target_compile_options(wunderlich_options INTERFACE -Werror)
endif()
if(WUNDERLICH_SANITIZE)
  target_compile_options(wunderlich_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(wunderlich_options INTERFACE -fsanitize=address,undefined)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3")
