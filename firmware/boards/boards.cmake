# What the folders of all boards share: how a program is linked and what comes out beside it.
#
#   edgeline_program(NAME SCRIPT FILE SOURCES FILE... [LIBRARIES TARGET...])
#       NAME.elf in the build folder, with NAME.map and NAME.bin, linked by the script; the build prints what each memory
#       region has in use, and the bytes of each section. The sources are the board's own and, on a Cortex-M,
#       ${EDGELINE_CORTEX_M_SOURCES}; report.c comes by itself.
#   edgeline_demo(SCRIPT FILE SOURCES FILE... PANEL NAME ROTATION DEGREES BAND LINES MEMORY BYTES [SCENE NAME])
#       The program edgeline-demo of firmware/apps/demo. PANEL and ROTATION are what the board has by default; EDGELINE_PANEL
#       and EDGELINE_ROTATION choose others. MEMORY is what renderer and stream share. SCENE is the one at the start, "demo"
#       unless it is named. With EDGELINE_SPARING it leaves out what has not changed; otherwise each frame is one window on
#       the display's wire, by which the boards' tests tell frames apart.
#   edgeline_examples(SCRIPT FILE SOURCES FILE... PANEL NAME ROTATION DEGREES)
#       The programs of firmware/examples/programs as example-NAME, not built unless asked for; `examples` is all of them.
#       PANEL and ROTATION as above.
include_guard(GLOBAL)

set(EDGELINE_BOARDS_DIR ${CMAKE_CURRENT_LIST_DIR})
include(${EDGELINE_BOARDS_DIR}/../examples/programs/examples.cmake)
set(EDGELINE_CORTEX_M_SOURCES ${EDGELINE_BOARDS_DIR}/cortex_m/start.c ${EDGELINE_BOARDS_DIR}/cortex_m/fault.c)

string(REGEX REPLACE "gcc$" "size" edgeline_size ${CMAKE_C_COMPILER})

set(EDGELINE_PANEL "" CACHE STRING "Panel of the demo; empty: the board's own")
option(EDGELINE_SPARING "The demo neither draws nor sends what has not changed; 10 KB of RAM for a colour panel")
set(EDGELINE_ROTATION "" CACHE STRING "How the panel is turned, degrees; empty: the board's own")
set(edgeline_tft_panels ili9341 st7789 st7789-240x240 st7735)
set(edgeline_oled_panels ssd1306 ssd0323)
set_property(CACHE EDGELINE_PANEL PROPERTY STRINGS "" ${edgeline_tft_panels} ${edgeline_oled_panels})
set_property(CACHE EDGELINE_ROTATION PROPERTY STRINGS "" 0 90 180 270)

function(edgeline_program name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "SCRIPT" "SOURCES;LIBRARIES")
    cmake_path(ABSOLUTE_PATH arg_SCRIPT)
    set(base ${CMAKE_BINARY_DIR}/${name})
    add_executable(${name} ${arg_SOURCES} ${EDGELINE_BOARDS_DIR}/report.c)
    set_target_properties(${name} PROPERTIES
        SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
        LINK_DEPENDS "${arg_SCRIPT};${EDGELINE_BOARDS_DIR}/cortex_m/sections.ld")
    target_include_directories(${name} PRIVATE ${EDGELINE_BOARDS_DIR})
    target_link_libraries(${name} PRIVATE edgeline ${arg_LIBRARIES} edgeline_flags)
    target_link_options(${name} PRIVATE
        -L ${EDGELINE_BOARDS_DIR}/cortex_m -T ${arg_SCRIPT} -Wl,-Map=${base}.map -Wl,--print-memory-usage -Wl,--fatal-warnings)
    add_custom_command(TARGET ${name} POST_BUILD
        COMMAND ${CMAKE_OBJCOPY} -O binary ${base}.elf ${base}.bin
        COMMAND ${CMAKE_COMMAND} -D SIZE=${edgeline_size} -D PROGRAM=${base}.elf -P ${EDGELINE_BOARDS_DIR}/print_sizes.cmake
        BYPRODUCTS ${base}.bin ${base}.map VERBATIM)
endfunction()

# EDGELINE_PANEL and EDGELINE_ROTATION instead of the caller's arg_PANEL and arg_ROTATION.
macro(edgeline_choose_panel)
    foreach(choice PANEL ROTATION)
        if(NOT EDGELINE_${choice} STREQUAL "")
            set(arg_${choice} ${EDGELINE_${choice}})
        endif()
    endforeach()
endmacro()

# What panel_tft.c and panel_oled.c of the demo ask for; also for other programs that show something.
function(edgeline_panel target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "PANEL;ROTATION;BAND" "")
    if(NOT arg_ROTATION MATCHES "^(0|90|180|270)$")
        message(FATAL_ERROR "EDGELINE_ROTATION is '${arg_ROTATION}', not one of 0, 90, 180, 270")
    endif()
    if(arg_PANEL IN_LIST edgeline_tft_panels)
        set(panel_source panel_tft.c)
    elseif(arg_PANEL IN_LIST edgeline_oled_panels)
        set(panel_source panel_oled.c)
    else()
        list(JOIN edgeline_tft_panels ", " tfts)
        list(JOIN edgeline_oled_panels ", " oleds)
        message(FATAL_ERROR "EDGELINE_PANEL is '${arg_PANEL}', not one of ${tfts}, ${oleds}")
    endif()
    string(REPLACE "-" "_" model ${arg_PANEL})
    string(TOUPPER ${model} macros)
    target_sources(${target} PRIVATE ${EDGELINE_BOARDS_DIR}/../apps/demo/${panel_source})
    target_compile_definitions(${target} PRIVATE
        EL_DEMO_ROTATION=EL_ROTATION_${arg_ROTATION}
        EL_DEMO_MODEL=el_${model} EL_DEMO_INIT=el_${model}_init EL_DEMO_SINK=el_${model}_sink
        EL_DEMO_PANEL_MEMORY=EL_${macros}_MEMORY_BYTES
        EL_DEMO_SPARING=$<BOOL:${EDGELINE_SPARING}>
        EL_DEMO_BAND_LINES=${arg_BAND})
endfunction()

function(edgeline_demo)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "SCRIPT;PANEL;ROTATION;BAND;MEMORY;SCENE" "SOURCES")
    if(NOT DEFINED arg_SCENE)
        set(arg_SCENE demo)
    endif()
    edgeline_choose_panel()
    edgeline_program(edgeline-demo SCRIPT ${arg_SCRIPT} LIBRARIES edgeline_scenes
        SOURCES ${arg_SOURCES} ${EDGELINE_BOARDS_DIR}/../apps/demo/main.c)
    edgeline_panel(edgeline-demo PANEL ${arg_PANEL} ROTATION ${arg_ROTATION} BAND ${arg_BAND})
    target_compile_definitions(edgeline-demo PRIVATE
        EL_DEMO_SCENE="${arg_SCENE}" EL_DEMO_PANEL="${arg_PANEL}" EL_DEMO_MEMORY_BYTES=${arg_MEMORY})
endfunction()

# The board's sources are compiled once for all of them.
function(edgeline_examples)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "SCRIPT;PANEL;ROTATION" "SOURCES")
    edgeline_choose_panel()
    add_library(edgeline_board OBJECT EXCLUDE_FROM_ALL ${arg_SOURCES})
    target_include_directories(edgeline_board PRIVATE ${EDGELINE_BOARDS_DIR})
    target_link_libraries(edgeline_board PRIVATE edgeline edgeline_flags)
    add_custom_target(examples)
    foreach(name ${EDGELINE_EXAMPLES})
        set(target example-${name})
        edgeline_program(${target} SCRIPT ${arg_SCRIPT} SOURCES $<TARGET_OBJECTS:edgeline_board>
            ${EDGELINE_EXAMPLES_DIR}/board_main.c)
        edgeline_example(${target} ${name} PANEL ${arg_PANEL} ROTATION ${arg_ROTATION})
        edgeline_panel(${target} PANEL ${EXAMPLE_PANEL_NAME} ROTATION ${EXAMPLE_PANEL_ROTATION} BAND 8)
        set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
        add_dependencies(examples ${target})
    endforeach()
endfunction()
