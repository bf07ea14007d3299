/* Commands are polled; bands are queued, so that the driver's DMA sends one while the next is drawn.
 *
 * D/C changes in the driver's callback before each transaction, when the one before has ended. The end of a queued
 * transaction is noticed when somebody waits for it, who sleeps meanwhile: in `wait`, or before the next transfer. The
 * driver copies what its DMA cannot read, such as constants in flash. Pixels go as bytes, whose order the panel's driver
 * exchanges: this SPI sends memory from its lowest address on. */
#include "bus.h"

#include <stdbool.h>

#include "driver/gpio.h"
#include "driver/spi_master.h"
#include "freertos/FreeRTOS.h"
#include "freertos/task.h"

enum { PIN_CLOCK = 4, PIN_DATA = 6, PIN_SELECT = 7, CLOCK_HZ = 40 * 1000 * 1000 };
static const gpio_num_t pin_dc = GPIO_NUM_5;
static const gpio_num_t pin_reset = GPIO_NUM_8;

static spi_device_handle_t device;
static spi_transaction_t transfer;
static bool open;
static void (*transfer_done)(void *argument);
static void *transfer_argument;

static void set_dc(spi_transaction_t *transaction)
{
    gpio_set_level(pin_dc, transaction->user != NULL);
}

/* `user` is not NULL for data. */
static spi_transaction_t transaction_of(const void *from, size_t bytes, bool data)
{
    return (spi_transaction_t){.length = 8 * bytes, .tx_buffer = from, .user = data ? &device : NULL};
}

/* Sleeps until the open transfer, if there is one, has ended. */
static void close_transfer(void)
{
    if (open) {
        spi_transaction_t *ended;
        ESP_ERROR_CHECK(spi_device_get_trans_result(device, &ended, portMAX_DELAY));
        open = false;
        transfer_done(transfer_argument);
    }
}

static void reset(void *context, int level)
{
    (void)context;
    close_transfer();
    gpio_set_level(pin_reset, level != 0);
}

static void command(void *context, uint8_t code, const uint8_t *parameters, size_t count)
{
    (void)context;
    close_transfer();
    spi_transaction_t first = transaction_of(&code, 1, false);
    ESP_ERROR_CHECK(spi_device_polling_transmit(device, &first));
    if (count > 0) {
        spi_transaction_t second = transaction_of(parameters, count, true);
        ESP_ERROR_CHECK(spi_device_polling_transmit(device, &second));
    }
}

static void bytes(void *context, const uint8_t *from, size_t count, void (*done)(void *argument), void *argument)
{
    (void)context;
    close_transfer();
    transfer = transaction_of(from, count, true);
    transfer_done = done;
    transfer_argument = argument;
    open = true;
    ESP_ERROR_CHECK(spi_device_queue_trans(device, &transfer, portMAX_DELAY));
}

/* One tick more, because the first one has begun already. */
static void delay_ms(void *context, uint32_t ms)
{
    (void)context;
    vTaskDelay((ms + portTICK_PERIOD_MS - 1) / portTICK_PERIOD_MS + 1);
}

static void wait(void *context)
{
    (void)context;
    close_transfer();
}

const el_bus *bus_start(size_t max_bytes)
{
    static const el_bus bus = {.reset = reset, .command = command, .bytes = bytes, .delay_ms = delay_ms, .wait = wait};
    const spi_bus_config_t pins = {.mosi_io_num = PIN_DATA,
                                   .miso_io_num = -1,
                                   .sclk_io_num = PIN_CLOCK,
                                   .quadwp_io_num = -1,
                                   .quadhd_io_num = -1,
                                   .max_transfer_sz = (int)max_bytes};
    const spi_device_interface_config_t display = {
        .mode = 0, .clock_speed_hz = CLOCK_HZ, .spics_io_num = PIN_SELECT, .queue_size = 1, .pre_cb = set_dc};

    ESP_ERROR_CHECK(gpio_set_direction(pin_dc, GPIO_MODE_OUTPUT));
    ESP_ERROR_CHECK(gpio_set_direction(pin_reset, GPIO_MODE_OUTPUT));
    ESP_ERROR_CHECK(spi_bus_initialize(SPI2_HOST, &pins, SPI_DMA_CH_AUTO));
    ESP_ERROR_CHECK(spi_bus_add_device(SPI2_HOST, &display, &device));
    return &bus;
}
