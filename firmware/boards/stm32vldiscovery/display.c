/* The OLED's wire: SPI1, polled.
 *
 * A frame of the SSD1306 is 1 KB, 1.4 ms at 6 MHz: less than what an interrupt for each byte would cost, and DMA would
 * win a tenth of a frame for another transfer's state. The SPI is the clock of its own wire, nothing outside can hold
 * it up, so every wait for it ends within two bytes' time. */
#include "stm32vldiscovery.h"

#include "cortex_m/systick.h"
#include "registers.h"

enum { RESET_PIN = 2, DATA_COMMAND_PIN = 3, SELECT_PIN = 4, CLOCK_PIN = 5, DATA_PIN = 7 }; /* of port A */

/* The last byte has left the wire: TXE first, because BSY falls between two bytes (RM0041, "Disabling the SPI"). */
static void wait_until_idle(void)
{
    while ((SPI_SR & SPI_SR_TX_EMPTY) == 0) {
    }
    while ((SPI_SR & SPI_SR_BUSY) != 0) {
    }
}

/* D/C belongs to the byte that is on the wire: it changes when there is none. */
static void send(const uint8_t *bytes, size_t count, uint32_t data_command)
{
    wait_until_idle();
    GPIO_SET_RESET(GPIO_A) = data_command;
    for (size_t i = 0; i < count; i++) {
        while ((SPI_SR & SPI_SR_TX_EMPTY) == 0) {
        }
        SPI_DR = bytes[i];
    }
}

static void command(void *context, uint8_t command, const uint8_t *parameters, size_t count)
{
    (void)context;
    send(&command, 1, GPIO_CLEAR(DATA_COMMAND_PIN));
    if (count > 0) {
        send(parameters, count, GPIO_SET(DATA_COMMAND_PIN));
    }
    wait_until_idle();
}

static void bytes(void *context, const uint8_t *bytes, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    send(bytes, count, GPIO_SET(DATA_COMMAND_PIN));
    done(argument);
}

static void reset(void *context, int level)
{
    (void)context;
    wait_until_idle();
    GPIO_SET_RESET(GPIO_A) = level != 0 ? GPIO_SET(RESET_PIN) : GPIO_CLEAR(RESET_PIN);
}

const el_bus el_vldiscovery_bus = {.reset = reset, .command = command, .bytes = bytes, .delay_ms = el_systick_delay_ms};

void el_vldiscovery_display_start(void)
{
    /* Selected for good: it is alone on its wires. */
    GPIO_SET_RESET(GPIO_A) = GPIO_CLEAR(SELECT_PIN) | GPIO_CLEAR(RESET_PIN) | GPIO_CLEAR(DATA_COMMAND_PIN);
    el_gpio_configure(GPIO_A, RESET_PIN, GPIO_MODE_OUTPUT);
    el_gpio_configure(GPIO_A, DATA_COMMAND_PIN, GPIO_MODE_OUTPUT);
    el_gpio_configure(GPIO_A, SELECT_PIN, GPIO_MODE_OUTPUT);
    el_gpio_configure(GPIO_A, CLOCK_PIN, GPIO_MODE_ALTERNATE);
    el_gpio_configure(GPIO_A, DATA_PIN, GPIO_MODE_ALTERNATE);

    /* The SSD1306 takes a bit at each rising edge of a clock of 10 MHz at most (data sheet, "4-wire Serial Interface
     * Timing"): the clock rests low, 24 MHz / 4 = 6 MHz. Nothing is received, so nothing has to be read. */
    SPI_CR1 = SPI_CR1_MASTER | SPI_CR1_DIVIDE_BY_4 | SPI_CR1_SELECTED | SPI_CR1_SOFTWARE_SELECT | SPI_CR1_TRANSMIT_ONLY;
    SPI_CR1 |= SPI_CR1_ENABLE;
}
