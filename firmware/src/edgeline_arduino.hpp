/* Edgeline on Arduino: a display's wire over SPI and three pins, a host's link over Serial. For every core that has SPI.h
 * and a 32-bit int; the only C++ of the library, and only for sketches that include it.
 *
 * The processor sends, since Arduino has no common way to DMA: a frame takes drawing and wire one after the other. Where
 * that is too slow, write the few functions of base/bus.h for your chip instead (PORTING.md). */
#ifndef EDGELINE_ARDUINO_HPP
#define EDGELINE_ARDUINO_HPP

#include <Arduino.h>
#include <SPI.h>
#include <string.h>

#include "edgeline.h"

/* The wire to a display. Other devices may share the SPI, by transactions of their own; chip select is low within ours
 * alone. Displays count a rise of chip select between two bytes as a pause. */
class EdgelineBus
{
  public:
    enum { NO_PIN = -1 };

    /* `spi` stays the sketch's. Pins are numbers of the core; reset_pin is NO_PIN where the module is reset together with
     * the board. The clock's nearest lower rate is taken. */
    EdgelineBus(SPIClass &spi, uint32_t clock_hz, int dc_pin, int cs_pin, int reset_pin = NO_PIN)
        : spi_(spi), clock_hz_(clock_hz), dc_pin_(dc_pin), cs_pin_(cs_pin), reset_pin_(reset_pin), bus_()
    {
        bus_.context = this;
        bus_.reset = reset;
        bus_.command = command;
        bus_.pixels = pixels;
        bus_.bytes = bytes;
        bus_.delay_ms = delay_ms;
    }
    EdgelineBus(const EdgelineBus &) = delete;
    EdgelineBus &operator=(const EdgelineBus &) = delete;

    /* Starts SPI and pins; in `setup`, before the panel's init. */
    void begin()
    {
        spi_.begin();
        output(cs_pin_);
        output(dc_pin_);
        output(reset_pin_);
    }

    /* For a panel's configuration. It refers to this object. */
    const el_bus *bus() const
    {
        return &bus_;
    }

  private:
    /* What SPI receives overwrites what was sent, and pixels are not ours to overwrite: so they go by way of the stack. */
    enum { CHUNK_BYTES = 64 };

    SPIClass &spi_;
    uint32_t clock_hz_;
    int dc_pin_, cs_pin_, reset_pin_;
    el_bus bus_;

    static EdgelineBus &of(void *context)
    {
        return *static_cast<EdgelineBus *>(context);
    }

    static void output(int pin)
    {
        if (pin != NO_PIN) {
            pinMode(pin, OUTPUT);
            digitalWrite(pin, HIGH);
        }
    }

    void open()
    {
        spi_.beginTransaction(SPISettings(clock_hz_, MSBFIRST, SPI_MODE0));
        digitalWrite(cs_pin_, LOW);
    }

    void close()
    {
        digitalWrite(cs_pin_, HIGH);
        spi_.endTransaction();
    }

    void send(const uint8_t *from, size_t count)
    {
        uint8_t chunk[CHUNK_BYTES];
        while (count > 0) {
            const size_t now = count < sizeof chunk ? count : sizeof chunk;
            memcpy(chunk, from, now);
            spi_.transfer(chunk, now);
            from += now;
            count -= now;
        }
    }

    static void reset(void *context, int level)
    {
        if (of(context).reset_pin_ != NO_PIN) {
            digitalWrite(of(context).reset_pin_, level != 0 ? HIGH : LOW);
        }
    }

    static void command(void *context, uint8_t code, const uint8_t *parameters, size_t count)
    {
        EdgelineBus &self = of(context);
        self.open();
        digitalWrite(self.dc_pin_, LOW);
        self.send(&code, 1);
        digitalWrite(self.dc_pin_, HIGH);
        self.send(parameters, count);
        self.close();
    }

    static void bytes(void *context, const uint8_t *from, size_t count, void (*done)(void *argument), void *argument)
    {
        EdgelineBus &self = of(context);
        self.open();
        self.send(from, count);
        self.close();
        done(argument);
    }

    static void pixels(void *context, const uint16_t *words, size_t count, void (*done)(void *argument), void *argument)
    {
        EdgelineBus &self = of(context);
        uint8_t chunk[CHUNK_BYTES];
        self.open();
        while (count > 0) {
            size_t used = 0;
            for (; count > 0 && used < sizeof chunk; count--, words++) {
                chunk[used++] = static_cast<uint8_t>(*words >> 8);
                chunk[used++] = static_cast<uint8_t>(*words);
            }
            self.spi_.transfer(chunk, used);
        }
        self.close();
        done(argument);
    }

    /* One more, because the first one has begun already. */
    static void delay_ms(void *, uint32_t ms)
    {
        delay(ms + 1);
    }
};

/* The link to a host over Serial, a USB one too, or any other Stream that knows how many bytes it takes without waiting
 * (availableForWrite); to one that does not, nothing is sent. */
class EdgelinePort
{
  public:
    /* `stream` stays the sketch's, which begins it. */
    explicit EdgelinePort(Stream &stream) : stream_(stream), port_()
    {
        port_.context = this;
        port_.write = write;
        port_.read = read;
        port_.micros = now_us;
        port_.wait = wait;
    }
    EdgelinePort(const EdgelinePort &) = delete;
    EdgelinePort &operator=(const EdgelinePort &) = delete;

    /* For el_stream_config. It refers to this object. */
    const el_port *port() const
    {
        return &port_;
    }

  private:
    Stream &stream_;
    el_port port_;

    static Stream &of(void *context)
    {
        return static_cast<EdgelinePort *>(context)->stream_;
    }

    static int32_t write(void *context, const uint8_t *bytes, size_t count)
    {
        const int room = of(context).availableForWrite();
        if (room <= 0 || count == 0) {
            return 0;
        }
        const size_t fitting = static_cast<size_t>(room);
        return static_cast<int32_t>(of(context).write(bytes, count < fitting ? count : fitting));
    }

    static int32_t read(void *context, uint8_t *bytes, size_t capacity)
    {
        size_t count = 0;
        while (count < capacity && of(context).available() > 0) {
            bytes[count++] = static_cast<uint8_t>(of(context).read());
        }
        return static_cast<int32_t>(count);
    }

    static uint32_t now_us(void *)
    {
        return static_cast<uint32_t>(micros());
    }

    static void wait(void *)
    {
        yield();
    }
};

#endif
