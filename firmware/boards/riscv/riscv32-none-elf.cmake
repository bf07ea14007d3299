# Toolchain file of all 32-bit RISC-V boards: Debian's riscv64-unknown-elf-gcc, which compiles for 32 bits too, and picolibc
# for string.h. EDGELINE_CPU names the core: rv32imc. -O2 unless a build type says otherwise; unused functions go.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv)
set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_ASM_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDGELINE_CPU)

# Zicsr, the control registers, became an extension of its own after ISA 2.1, and the assembler wants it named; but gcc 12
# finds no 32-bit libraries under that longer name. Assembly that reads control registers says `.option arch, +zicsr`.
set(edgeline_cpu_rv32imc -march=rv32imc -mabi=ilp32)
if(NOT DEFINED edgeline_cpu_${EDGELINE_CPU})
    message(FATAL_ERROR "EDGELINE_CPU is '${EDGELINE_CPU}', not rv32imc")
endif()
list(JOIN edgeline_cpu_${EDGELINE_CPU} " " edgeline_cpu)
set(CMAKE_C_FLAGS_INIT "${edgeline_cpu} --specs=picolibc.specs -ffunction-sections -fdata-sections")
set(CMAKE_ASM_FLAGS_INIT "${edgeline_cpu}")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,--gc-sections")
# Not _INIT: that goes before CMake's own -O3.
set(CMAKE_C_FLAGS_RELEASE "-O2 -g -DNDEBUG" CACHE STRING "Flags of release builds")
