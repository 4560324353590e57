# wunderlich_npm(folder what [arguments of `npm ci`]): the packages that folder/package-lock.json names, in the current
# build folder, so that the source tree stays clean and two builds do not disturb each other. Depend on WUNDERLICH_PACKAGES.
find_program(WUNDERLICH_NPM npm NO_CMAKE_FIND_ROOT_PATH)
find_program(WUNDERLICH_NODE NAMES node nodejs NO_CMAKE_FIND_ROOT_PATH)
if(NOT WUNDERLICH_NPM OR NOT WUNDERLICH_NODE)
  message(FATAL_ERROR "node (18 or later) and npm are needed to build the pages; "
                      "configure with -DWUNDERLICH_APP=OFF to do without the program")
endif()

function(wunderlich_npm folder what)
  set(installed ${CMAKE_CURRENT_BINARY_DIR}/node_modules/.package-lock.json)
  get_filename_component(folder ${folder} ABSOLUTE)
  add_custom_command(
    OUTPUT ${installed}
    COMMAND ${CMAKE_COMMAND} -E copy ${folder}/package.json ${folder}/package-lock.json ${CMAKE_CURRENT_BINARY_DIR}
    COMMAND ${WUNDERLICH_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error ${ARGN}
    COMMAND ${CMAKE_COMMAND} -E touch ${installed}
    DEPENDS ${folder}/package.json ${folder}/package-lock.json
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
    COMMENT "Fetching ${what}"
    VERBATIM)
  set(WUNDERLICH_PACKAGES ${installed} PARENT_SCOPE)
endfunction()
