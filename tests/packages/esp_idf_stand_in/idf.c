/* The hardware below the stand-in's ESP-IDF: a display's wire that is recorded (sim/wire_trace.h). STAND_IN_TRACE names
 * the recording; the run ends after STAND_IN_FRAMES frames, each of which ends with a delay of one tick.
 *
 * A queued transaction is carried out when its result is fetched, as late as it can be in life: who gives the memory away
 * before that is seen. What the driver would refuse, or do wrong in silence, ends the run. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "driver/gpio.h"
#include "driver/spi_master.h"
#include "freertos/task.h"

#include "../wire_record.h"

enum { PIN_DC = 5, PIN_RESET = 8, NS_PER_TICK = 10000000 };

void app_main(void);

struct spi_device_t {
    spi_device_interface_config_t config;
};

static FILE *trace;
static uint32_t unwritten_ns;
static int frames_left;
static bool is_output[GPIO_NUM_MAX];
static uint32_t level[GPIO_NUM_MAX];
static int max_bytes;
static struct spi_device_t device;
static spi_transaction_t *queued;

static void fail(const char *what)
{
    fprintf(stderr, "stand-in: %s\n", what);
    exit(1);
}

static const char *setting(const char *name)
{
    const char *const text = getenv(name);
    if (text == NULL) {
        fail(name);
    }
    return text;
}

static void record(int kind, int value)
{
    write_record(trace, unwritten_ns, kind, value);
    unwritten_ns = 0;
}

void stand_in_check(esp_err_t status, const char *what)
{
    if (status != ESP_OK) {
        fail(what);
    }
}

esp_err_t gpio_set_direction(gpio_num_t gpio_num, gpio_mode_t mode)
{
    is_output[gpio_num] = mode == GPIO_MODE_OUTPUT;
    return ESP_OK;
}

esp_err_t gpio_set_level(gpio_num_t gpio_num, uint32_t new_level)
{
    if (!is_output[gpio_num]) {
        fail("the level of a pin that is no output");
    }
    level[gpio_num] = new_level;
    if ((int)gpio_num == PIN_RESET) {
        record(TRACE_RESET, (int)new_level);
    }
    return ESP_OK;
}

esp_err_t spi_bus_initialize(spi_host_device_t host_id, const spi_bus_config_t *bus_config, spi_dma_chan_t dma_chan)
{
    (void)host_id;
    (void)dma_chan;
    max_bytes = bus_config->max_transfer_sz;
    return ESP_OK;
}

esp_err_t spi_bus_add_device(spi_host_device_t host_id, const spi_device_interface_config_t *dev_config,
                             spi_device_handle_t *handle)
{
    (void)host_id;
    if (dev_config->mode != 0 && dev_config->mode != 3) {
        fail("an SPI mode that displays do not take");
    }
    device.config = *dev_config;
    *handle = &device;
    return ESP_OK;
}

static void transmit(spi_transaction_t *transaction)
{
    const uint8_t *const bytes = transaction->tx_buffer;
    if (transaction->length % 8 != 0 || transaction->length > 8U * (unsigned)max_bytes) {
        fail("a transaction of half bytes, or longer than max_transfer_sz");
    }
    device.config.pre_cb(transaction);
    for (size_t i = 0; i < transaction->length / 8; i++) {
        record(level[PIN_DC] != 0 ? TRACE_DATA : TRACE_COMMAND, bytes[i]);
    }
}

esp_err_t spi_device_queue_trans(spi_device_handle_t handle, spi_transaction_t *trans_desc, TickType_t ticks_to_wait)
{
    (void)handle;
    (void)ticks_to_wait;
    if (queued != NULL) {
        fail("a second transaction in the queue, which the example does not do");
    }
    queued = trans_desc;
    return ESP_OK;
}

esp_err_t spi_device_get_trans_result(spi_device_handle_t handle, spi_transaction_t **trans_desc,
                                      TickType_t ticks_to_wait)
{
    (void)handle;
    (void)ticks_to_wait;
    if (queued == NULL) {
        fail("waits for a transaction that was never queued");
    }
    *trans_desc = queued;
    transmit(queued);
    queued = NULL;
    return ESP_OK;
}

esp_err_t spi_device_polling_transmit(spi_device_handle_t handle, spi_transaction_t *trans_desc)
{
    (void)handle;
    if (queued != NULL) {
        fail("a polled transaction while another is queued");
    }
    transmit(trans_desc);
    return ESP_OK;
}

/* As short as it may be: the first tick has begun already. */
void vTaskDelay(const TickType_t xTicksToDelay)
{
    unwritten_ns += (xTicksToDelay - 1) * NS_PER_TICK;
    if (xTicksToDelay == 1 && --frames_left == 0) {
        if (queued != NULL) {
            transmit(queued);
        }
        exit(fclose(trace) == 0 ? 0 : 1);
    }
}

int main(void)
{
    frames_left = atoi(setting("STAND_IN_FRAMES"));
    trace = fopen(setting("STAND_IN_TRACE"), "wb");
    if (trace == NULL) {
        fail("cannot write STAND_IN_TRACE");
    }
    fputs("HOT1", trace);
    app_main();
    return 1; /* it does not return */
}
