/* The command table. Source: ILITEK, "ILI9341 a-Si TFT LCD Single Chip Driver 240RGBx320 Resolution and 262K color",
 * V1.11; the page is in the comment of each line. Commands without a case in dcs_lcd.c (voltages, gamma, timing) do not
 * change which pixel is where: the model checks their parameter counts only. */
#include "dcs_commands.h"

#include <stddef.h>

static const el_dcs_command COMMANDS[] = {
    {EL_DCS_NOP, 0, 0, "NOP", "8.2.1"},                                  /* p. 89 */
    {EL_DCS_SWRESET, 0, 0, "SWRESET", "8.2.2"},                          /* p. 90 */
    {EL_DCS_SLPIN, 0, 0, "SLPIN", "8.2.11"},                             /* p. 100 */
    {EL_DCS_SLPOUT, 0, 0, "SLPOUT", "8.2.12"},                           /* p. 101 */
    {EL_DCS_NORON, 0, 0, "NORON", "8.2.14"},                             /* p. 104 */
    {EL_DCS_INVOFF, 0, 0, "INVOFF", "8.2.15"},                           /* p. 105 */
    {EL_DCS_INVON, 0, 0, "INVON", "8.2.16"},                             /* p. 106 */
    {EL_DCS_GAMSET, 1, 1, "GAMSET", "8.2.17"},                           /* p. 107 */
    {EL_DCS_DISPOFF, 0, 0, "DISPOFF", "8.2.18"},                         /* p. 108 */
    {EL_DCS_DISPON, 0, 0, "DISPON", "8.2.19"},                           /* p. 109 */
    {EL_DCS_CASET, 4, 4, "CASET", "8.2.20"},                             /* p. 110 */
    {EL_DCS_PASET, 4, 4, "PASET", "8.2.21"},                             /* p. 112 */
    {EL_DCS_RAMWR, 0, 0, "RAMWR", "8.2.22"},                             /* p. 114 */
    {EL_DCS_VSCRDEF, 6, 6, "VSCRDEF", "8.2.26"},                         /* p. 120 */
    {EL_DCS_TEOFF, 0, 0, "TEOFF", "8.2.27"},                             /* p. 124 */
    {EL_DCS_TEON, 1, 1, "TEON", "8.2.28"},                               /* p. 125 */
    {EL_DCS_MADCTL, 1, 1, "MADCTL", "8.2.29"},                           /* p. 127 */
    {EL_DCS_VSCRSADD, 2, 2, "VSCRSADD", "8.2.30"},                       /* p. 129 */
    {EL_DCS_IDMOFF, 0, 0, "IDMOFF", "8.2.31"},                           /* p. 131 */
    {EL_DCS_IDMON, 0, 0, "IDMON", "8.2.32"},                             /* p. 132 */
    {EL_DCS_COLMOD, 1, 1, "COLMOD", "8.2.33"},                           /* p. 134 */
    {EL_DCS_RAMWRC, 0, 0, "RAMWRC", "8.2.34"},                           /* p. 135 */
    {EL_DCS_WRDISBV, 1, 1, "WRDISBV", "8.2.38"},                         /* p. 141 */
    {EL_DCS_WRCTRLD, 1, 1, "WRCTRLD", "8.2.40"},                         /* p. 143 */
    {EL_ILI_FRMCTR1, 2, 2, "FRMCTR1", "8.3.2"},                          /* p. 155 */
    {EL_ILI_INVTR, 1, 1, "INVTR", "8.3.5"},                              /* p. 161 */
    {EL_ILI_DISCTRL, 3, 4, "DISCTRL", "8.3.7"},                          /* p. 164; the fourth, PCDIV, divides an
                                                                              external clock, and drivers leave it out */
    {EL_ILI_ETMOD, 1, 1, "ETMOD", "8.3.8"},                              /* p. 168 */
    {EL_ILI_PWCTRL1, 1, 1, "PWCTRL1", "8.3.16"},                         /* p. 178 */
    {EL_ILI_PWCTRL2, 1, 1, "PWCTRL2", "8.3.17"},                         /* p. 179 */
    {EL_ILI_VMCTRL1, 2, 2, "VMCTRL1", "8.3.18"},                         /* p. 180 */
    {EL_ILI_VMCTRL2, 1, 1, "VMCTRL2", "8.3.19"},                         /* p. 182 */
    {EL_ILI_POWER_A, 5, 5, "Power control A", "8.4.1"},                  /* p. 195 */
    {EL_ILI_POWER_B, 3, 3, "Power control B", "8.4.2"},                  /* p. 196 */
    {EL_ILI_PGAMCTRL, 15, 15, "PGAMCTRL", "8.3.24"},                     /* p. 188 */
    {EL_ILI_NGAMCTRL, 15, 15, "NGAMCTRL", "8.3.25"},                     /* p. 189 */
    {EL_ILI_TIMING_A, 3, 3, "Driver timing control A", "8.4.3"},         /* p. 197 */
    {EL_ILI_TIMING_B, 2, 2, "Driver timing control B", "8.4.5"},         /* p. 199 */
    {EL_ILI_POWER_SEQUENCE, 4, 4, "Power on sequence control", "8.4.6"}, /* p. 200 */
    {EL_ILI_ENABLE_3G, 1, 1, "Enable 3G", "8.4.7"},                      /* p. 201 */
    {EL_ILI_IFCTL, 3, 3, "IFCTL", "8.3.28"},                             /* p. 192 */
    {EL_ILI_PUMP_RATIO, 1, 1, "Pump ratio control", "8.4.8"},            /* p. 202 */
};

const el_dcs_command *el_dcs_find(uint8_t code)
{
    for (size_t i = 0; i < sizeof COMMANDS / sizeof COMMANDS[0]; i++) {
        if (COMMANDS[i].code == code) {
            return &COMMANDS[i];
        }
    }
    return NULL;
}
