/* Names and types of ESP-IDF 5 (components/esp_common/include/esp_err.h). */
#ifndef ESP_ERR_H
#define ESP_ERR_H

typedef int esp_err_t;

#define ESP_OK 0
#define ESP_ERR_TIMEOUT 0x107
#define ESP_ERROR_CHECK(x) stand_in_check((x), #x)

void stand_in_check(esp_err_t status, const char *what);

#endif
