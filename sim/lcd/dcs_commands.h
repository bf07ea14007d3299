/* The commands that the LCD model knows: names, parameter counts and where the data sheet has them.
 *
 * A table, so that the model's byte handling has no knowledge of single commands, and so that each error can name the
 * command and the section to read. */
#ifndef EL_SIM_LCD_DCS_COMMANDS_H
#define EL_SIM_LCD_DCS_COMMANDS_H

#include <stdint.h>

enum {
    EL_DCS_NOP = 0x00,
    EL_DCS_SWRESET = 0x01,
    EL_DCS_SLPIN = 0x10,
    EL_DCS_SLPOUT = 0x11,
    EL_DCS_NORON = 0x13,
    EL_DCS_INVOFF = 0x20,
    EL_DCS_INVON = 0x21,
    EL_DCS_GAMSET = 0x26,
    EL_DCS_DISPOFF = 0x28,
    EL_DCS_DISPON = 0x29,
    EL_DCS_CASET = 0x2A,
    EL_DCS_PASET = 0x2B,
    EL_DCS_RAMWR = 0x2C,
    EL_DCS_VSCRDEF = 0x33,
    EL_DCS_TEOFF = 0x34,
    EL_DCS_TEON = 0x35,
    EL_DCS_MADCTL = 0x36,
    EL_DCS_VSCRSADD = 0x37,
    EL_DCS_IDMOFF = 0x38,
    EL_DCS_IDMON = 0x39,
    EL_DCS_COLMOD = 0x3A,
    EL_DCS_RAMWRC = 0x3C,
    EL_DCS_WRDISBV = 0x51,
    EL_DCS_WRCTRLD = 0x53,
    EL_ILI_FRMCTR1 = 0xB1,
    EL_ILI_INVTR = 0xB4,
    EL_ILI_DISCTRL = 0xB6,
    EL_ILI_ETMOD = 0xB7,
    EL_ILI_PWCTRL1 = 0xC0,
    EL_ILI_PWCTRL2 = 0xC1,
    EL_ILI_VMCTRL1 = 0xC5,
    EL_ILI_VMCTRL2 = 0xC7,
    EL_ILI_POWER_A = 0xCB,
    EL_ILI_POWER_B = 0xCF,
    EL_ILI_PGAMCTRL = 0xE0,
    EL_ILI_NGAMCTRL = 0xE1,
    EL_ILI_TIMING_A = 0xE8,
    EL_ILI_TIMING_B = 0xEA,
    EL_ILI_POWER_SEQUENCE = 0xED,
    EL_ILI_ENABLE_3G = 0xF2,
    EL_ILI_IFCTL = 0xF6,
    EL_ILI_PUMP_RATIO = 0xF7,
};

enum { EL_DCS_MAX_PARAMETERS = 15 };

typedef struct el_dcs_command {
    uint8_t code;
    uint8_t min_parameters; /* unused by RAMWR and RAMWRC, which take any number of pixels */
    uint8_t max_parameters;
    const char *name;    /* as the data sheet has it */
    const char *section; /* of the ILI9341 data sheet V1.11 */
} el_dcs_command;

/* The table's entry of `code`, or NULL when the model does not know it. */
const el_dcs_command *el_dcs_find(uint8_t code);

#endif
