#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "inputs.h"
#include "paint/pages.h"
#include "report.h"
#include "scene.h"

int el_command_list(int argc, char **argv)
{
    if (argc == 1 && strcmp(argv[0], "views") == 0) {
        for (unsigned i = 0; i < el_view_count; i++) {
            printf("%-12s %s\n", el_view_names[i], el_view_summaries[i]);
        }
        return EL_EXIT_OK;
    }
    if (argc == 1 && strcmp(argv[0], "pages") == 0) {
        for (size_t i = 0; i < el_page_count; i++) {
            printf("%-12s %s\n", el_pages[i]->name, el_pages[i]->summary);
        }
        return EL_EXIT_OK;
    }
    if (argc != 0) {
        return el_report("list takes no arguments, or `views` or `pages`");
    }
    for (size_t i = 0; i < el_scene_count(); i++) {
        printf("%-12s %s\n", el_scene_at(i)->name, el_scene_at(i)->summary);
    }
    return EL_EXIT_OK;
}
