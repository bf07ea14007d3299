# Toolchain file of all Cortex-M boards. EDGELINE_CPU names the core: cortex-m0plus, cortex-m3, cortex-m4f, cortex-m7,
# cortex-m33. -O2 unless a build type says otherwise; unused functions go.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_ASM_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDGELINE_CPU)

set(edgeline_cpu_cortex-m0plus -mcpu=cortex-m0plus -mfloat-abi=soft)
set(edgeline_cpu_cortex-m3 -mcpu=cortex-m3 -mfloat-abi=soft)
set(edgeline_cpu_cortex-m4f -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard)
set(edgeline_cpu_cortex-m7 -mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard)
set(edgeline_cpu_cortex-m33 -mcpu=cortex-m33 -mfpu=fpv5-sp-d16 -mfloat-abi=hard)
if(NOT DEFINED edgeline_cpu_${EDGELINE_CPU})
    message(FATAL_ERROR "EDGELINE_CPU is '${EDGELINE_CPU}', not one of "
        "cortex-m0plus, cortex-m3, cortex-m4f, cortex-m7, cortex-m33")
endif()
list(JOIN edgeline_cpu_${EDGELINE_CPU} " " edgeline_cpu)
set(CMAKE_C_FLAGS_INIT "${edgeline_cpu} -mthumb -ffunction-sections -fdata-sections")
set(CMAKE_ASM_FLAGS_INIT "${edgeline_cpu} -mthumb")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles -Wl,--gc-sections")
# Not _INIT: that goes before CMake's own -O3.
set(CMAKE_C_FLAGS_RELEASE "-O2 -g -DNDEBUG" CACHE STRING "Flags of release builds")
