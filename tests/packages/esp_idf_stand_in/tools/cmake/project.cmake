# A stand-in for ESP-IDF's build system, so that the component and its example are built where ESP-IDF cannot be installed.
#
# As the real one it replaces project(): components come from EXTRA_COMPONENT_DIRS, then main, which sees all of them.
# What each component registers is written to components.txt. The compiler is whoever the build is configured with: for an
# ESP32-C3's instruction set, or this machine's, for which idf.c makes a program of it.
set(ESP_PLATFORM 1)
set(stand_in_dir ${CMAKE_CURRENT_LIST_DIR}/../..)

function(idf_component_register)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "SRCS;INCLUDE_DIRS;PRIV_INCLUDE_DIRS;REQUIRES;PRIV_REQUIRES")
    if(DEFINED arg_UNPARSED_ARGUMENTS OR NOT DEFINED arg_SRCS)
        message(FATAL_ERROR "idf_component_register: no SRCS, or unknown words: ${arg_UNPARSED_ARGUMENTS}")
    endif()
    cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME component)
    get_property(others GLOBAL PROPERTY idf_components)
    add_library(__idf_${component} STATIC ${arg_SRCS})
    target_include_directories(__idf_${component}
        PUBLIC ${arg_INCLUDE_DIRS} ${stand_in_dir}/include PRIVATE ${arg_PRIV_INCLUDE_DIRS})
    target_compile_options(__idf_${component} PRIVATE -std=gnu17 -Wall -Wextra -Werror)
    if(component STREQUAL "main")
        target_link_libraries(__idf_${component} PUBLIC ${others})
    endif()
    set_property(GLOBAL APPEND PROPERTY idf_components __idf_${component})
    file(APPEND ${CMAKE_BINARY_DIR}/components.txt "${component}|${arg_SRCS}|${arg_INCLUDE_DIRS}\n")
endfunction()

macro(project name)
    _project(${name} LANGUAGES C)
    file(REMOVE ${CMAKE_BINARY_DIR}/components.txt)
    foreach(folder IN LISTS EXTRA_COMPONENT_DIRS ITEMS ${CMAKE_CURRENT_SOURCE_DIR}/main)
        cmake_path(NORMAL_PATH folder)
        cmake_path(GET folder FILENAME component)
        add_subdirectory(${folder} ${CMAKE_BINARY_DIR}/esp-idf/${component})
    endforeach()
    if(NOT CMAKE_CROSSCOMPILING)
        add_executable(${name} ${stand_in_dir}/idf.c)
        target_link_libraries(${name} PRIVATE __idf_main)
    endif()
endmacro()
