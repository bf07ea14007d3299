/* The simulator's commands. Each takes the arguments after its name and returns the exit status. */
#ifndef EL_SIM_COMMANDS_H
#define EL_SIM_COMMANDS_H

int el_command_list(int argc, char **argv);
int el_command_paint(int argc, char **argv);
int el_command_render(int argc, char **argv);
int el_command_look(int argc, char **argv);
int el_command_memory(int argc, char **argv);
int el_command_budget(int argc, char **argv);
int el_command_stream(int argc, char **argv);
int el_command_coverage(int argc, char **argv);
int el_command_attributes(int argc, char **argv);
int el_command_methods(int argc, char **argv);

#endif
