#include <stdio.h>

#include "commands.h"
#include "report.h"
#include "scene.h"

int el_command_list(int argc, char **argv)
{
    (void)argv;
    if (argc != 0) {
        return el_report("list takes no arguments");
    }
    for (size_t i = 0; i < el_scene_count(); i++) {
        printf("%-12s %s\n", el_scene_at(i)->name, el_scene_at(i)->summary);
    }
    return EL_EXIT_OK;
}
