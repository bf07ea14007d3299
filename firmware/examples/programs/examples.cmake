# The programs of this folder, for whoever builds them: the simulator (sim/examples) and boards.
#
#   EDGELINE_EXAMPLES        their names
#   edgeline_example(TARGET NAME [PANEL NAME] [ROTATION DEGREES])
#       makes TARGET, an executable that has the main of where it runs, the program NAME on that panel, or on the one that
#       the program is for. Sets EXAMPLE_PANEL_NAME and EXAMPLE_PANEL_ROTATION for the caller.
include_guard(DIRECTORY)

set(EDGELINE_EXAMPLES attitude_indicator flush_callback hello_triangle menu one_bit oscilloscope product_viewer
    spinning_model textured_room)
set(EDGELINE_EXAMPLES_DIR ${CMAKE_CURRENT_LIST_DIR})
set(EDGELINE_EXAMPLE_MODEL ${CMAKE_CURRENT_LIST_DIR}/../SpinningModel/gem.h CACHE FILEPATH
    "The model of spinning_model: a header that `edgeline convert` has made")

# Width and height of each panel's glass, upright.
set(edgeline_glass_ili9341 240 320)
set(edgeline_glass_st7789 240 320)
set(edgeline_glass_st7789-240x240 240 240)
set(edgeline_glass_st7735 128 160)
set(edgeline_glass_ssd1306 128 64)
set(edgeline_glass_ssd0323 128 64)

# The meshes of a header of `edgeline convert`: one for each material, in the order in which they are drawn.
function(edgeline_example_model target)
    if(NOT EXISTS ${EDGELINE_EXAMPLE_MODEL})
        message(FATAL_ERROR "EDGELINE_EXAMPLE_MODEL is '${EDGELINE_EXAMPLE_MODEL}', which does not exist; give a header's "
                            "whole path")
    endif()
    set(definition "^static const el_material ([A-Za-z0-9_]+)_material = {")
    file(STRINGS ${EDGELINE_EXAMPLE_MODEL} materials REGEX "${definition}")
    if(NOT materials)
        message(FATAL_ERROR "${EDGELINE_EXAMPLE_MODEL} holds no mesh with its material; `edgeline convert` makes such "
                            "headers")
    endif()
    set(parts "")
    foreach(line IN LISTS materials)
        string(REGEX MATCH "${definition}" line ${line})
        string(APPEND parts "PART(${CMAKE_MATCH_1})")
    endforeach()
    target_compile_definitions(${target} PRIVATE
        EXAMPLE_MODEL_FILE="${EDGELINE_EXAMPLE_MODEL}" EXAMPLE_MODEL_PARTS=${parts})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${EDGELINE_EXAMPLE_MODEL}) # its names may change
endfunction()

function(edgeline_example target name)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "PANEL;ROTATION" "")
    if(name STREQUAL one_bit)
        set(arg_PANEL ssd1306)
        set(arg_ROTATION 0)
    endif()
    set(glass ${edgeline_glass_${arg_PANEL}})
    if(arg_ROTATION MATCHES "^(90|270)$")
        list(REVERSE glass)
    endif()
    list(GET glass 0 width)
    list(GET glass 1 height)
    target_sources(${target} PRIVATE ${EDGELINE_EXAMPLES_DIR}/${name}.c ${EDGELINE_EXAMPLES_DIR}/example.c)
    if(name STREQUAL flush_callback)
        target_sources(${target} PRIVATE ${EDGELINE_EXAMPLES_DIR}/gui_stand_in.c)
    elseif(name STREQUAL spinning_model)
        edgeline_example_model(${target})
    endif()
    target_include_directories(${target} PRIVATE ${EDGELINE_EXAMPLES_DIR} ${EDGELINE_EXAMPLES_DIR}/../../apps)
    target_compile_definitions(${target} PRIVATE EXAMPLE_NAME="${name}"
        EXAMPLE_WIDTH=${width} EXAMPLE_HEIGHT=${height} EXAMPLE_BAND=8)
    set(EXAMPLE_PANEL_NAME ${arg_PANEL} PARENT_SCOPE)
    set(EXAMPLE_PANEL_ROTATION ${arg_ROTATION} PARENT_SCOPE)
endfunction()
