/* The stand-in's hardware: a display's wire that is recorded (sim/wire_trace.h), Serial on standard input and output.
 *
 * It is as strict as a real board is silent: a byte outside a transaction, without chip select, or before a pin is an
 * output, ends the run. As in life, `transfer` overwrites what it sent. STAND_IN_TRACE names the recording,
 * STAND_IN_LOOPS is how often `loop` runs. The sketches' pins: D/C 9, chip select 10, reset 8. */
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "Arduino.h"
#include "SPI.h"

#include "../wire_record.h"

namespace
{

enum { RESET_PIN = 8, DC_PIN = 9, CS_PIN = 10, PINS = 32, SERIAL_ROOM = 63, RECEIVED_GARBAGE = 0xA5 };

FILE *trace;
uint64_t now_ns;
uint64_t written_ns;
bool is_output[PINS];
int level[PINS];

void fail(const char *what)
{
    std::fprintf(stderr, "stand-in: %s\n", what);
    std::exit(1);
}

void record(int kind, int value)
{
    write_record(trace, static_cast<uint32_t>(now_ns - written_ns), kind, value);
    written_ns = now_ns;
}

class RecordedSpi : public SPIClass
{
  public:
    uint8_t transfer(uint8_t data) override
    {
        if (!begun_ || !open_ || level[CS_PIN] != LOW) {
            fail("a byte before SPI.begin, outside a transaction, or without chip select");
        }
        if (!is_output[CS_PIN] || !is_output[DC_PIN] || !is_output[RESET_PIN]) {
            fail("a byte while a pin of the display is no output");
        }
        now_ns += 8ULL * 1000000000ULL / settings_.getClockFreq();
        record(level[DC_PIN] != LOW ? TRACE_DATA : TRACE_COMMAND, data);
        return RECEIVED_GARBAGE;
    }
    uint16_t transfer16(uint16_t data) override
    {
        const int high = transfer(highByte(data));
        return static_cast<uint16_t>(high << 8 | transfer(lowByte(data)));
    }
    void transfer(void *buf, size_t count) override
    {
        for (uint8_t *at = static_cast<uint8_t *>(buf); count > 0; at++, count--) {
            *at = transfer(*at);
        }
    }
    void usingInterrupt(int) override
    {
    }
    void notUsingInterrupt(int) override
    {
    }
    void attachInterrupt() override
    {
    }
    void detachInterrupt() override
    {
    }
    void beginTransaction(SPISettings settings) override
    {
        if (open_) {
            fail("a transaction within a transaction");
        }
        if (settings.getBitOrder() != MSBFIRST ||
            (settings.getDataMode() != SPI_MODE0 && settings.getDataMode() != SPI_MODE3)) {
            fail("a bit order or mode that displays do not take");
        }
        open_ = true;
        settings_ = settings;
    }
    void endTransaction() override
    {
        if (!open_ || level[CS_PIN] == LOW) {
            fail("the end of no transaction, or with chip select low");
        }
        open_ = false;
    }
    void begin() override
    {
        begun_ = true;
    }
    void end() override
    {
        begun_ = false;
    }

  private:
    bool begun_ = false;
    bool open_ = false;
    SPISettings settings_;
};

/* Takes as many bytes at a time as a core's ring does; none before `begin`. */
class StandardSerial : public HardwareSerial
{
  public:
    size_t write(uint8_t value) override
    {
        return write(&value, 1);
    }
    size_t write(const uint8_t *buffer, size_t size) override
    {
        if (!begun_ || size > SERIAL_ROOM) {
            fail("Serial.write before begin, or of more than availableForWrite says");
        }
        return std::fwrite(buffer, 1, size, stdout);
    }
    int availableForWrite() override
    {
        return begun_ ? SERIAL_ROOM : 0;
    }
    int available() override
    {
        return peek() == EOF ? 0 : 1;
    }
    int read() override
    {
        return std::getchar();
    }
    int peek() override
    {
        const int next = std::getchar();
        return next == EOF ? EOF : std::ungetc(next, stdin);
    }
    void begin(unsigned long) override
    {
        begun_ = true;
    }
    void end() override
    {
    }
    void flush() override
    {
    }
    operator bool() override
    {
        return true;
    }

  private:
    bool begun_ = false;
};

RecordedSpi recorded_spi;
StandardSerial standard_serial;

const char *setting(const char *name)
{
    const char *const text = std::getenv(name);
    if (text == nullptr) {
        fail(name);
    }
    return text;
}

} // namespace

SPIClass &SPI = recorded_spi;
HardwareSerial &Serial = standard_serial;

size_t Print::println(const char text[])
{
    std::fprintf(stderr, "%s\n", text);
    std::exit(1); /* sketches print what they cannot go on from */
}

void pinMode(pin_size_t pin, PinMode mode)
{
    is_output[pin % PINS] = mode == OUTPUT;
}

void digitalWrite(pin_size_t pin, PinStatus status)
{
    if (pin == RESET_PIN && level[pin] != static_cast<int>(status)) {
        record(TRACE_RESET, status);
    }
    level[pin % PINS] = status;
}

unsigned long micros()
{
    now_ns += 1000;
    return static_cast<uint32_t>(now_ns / 1000);
}

unsigned long millis()
{
    return micros() / 1000;
}

/* As short as cores may make it: the first millisecond has begun already. */
void delay(unsigned long ms)
{
    now_ns += (ms - 1) * 1000000ULL;
}

void yield()
{
}

int main()
{
    trace = std::fopen(setting("STAND_IN_TRACE"), "wb");
    if (trace == nullptr) {
        fail("cannot write STAND_IN_TRACE");
    }
    std::fputs("HOT1", trace);
    setup();
    for (int i = std::atoi(setting("STAND_IN_LOOPS")); i > 0; i--) {
        loop();
    }
    return std::fclose(trace) == 0 && std::fflush(stdout) == 0 ? 0 : 1;
}
