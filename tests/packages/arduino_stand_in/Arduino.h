/* A stand-in for an Arduino core, so that sketches can be compiled, and run, where no core can be installed.
 *
 * Names, types and signatures are those of ArduinoCore-API (api/Common.h, Print.h, Stream.h, HardwareSerial.h), macros
 * that may get in the way among them; of Print only what a sketch of ours prints with. What it does is in stand_in.cpp. */
#ifndef ARDUINO_STAND_IN_ARDUINO_H
#define ARDUINO_STAND_IN_ARDUINO_H

#include <stddef.h>
#include <stdint.h>

typedef enum { LOW = 0, HIGH = 1, CHANGE = 2, FALLING = 3, RISING = 4 } PinStatus;
typedef enum { INPUT = 0, OUTPUT = 1, INPUT_PULLUP = 2, INPUT_PULLDOWN = 3, OUTPUT_OPENDRAIN = 4 } PinMode;
typedef enum { LSBFIRST = 0, MSBFIRST = 1 } BitOrder;
typedef uint8_t pin_size_t;
typedef bool boolean;
typedef uint8_t byte;
typedef uint16_t word;

#define PI 3.1415926535897932384626433832795
#define SERIAL 0x0
#define DISPLAY 0x1
#define constrain(amt, low, high) ((amt) < (low) ? (low) : ((amt) > (high) ? (high) : (amt)))
#define radians(deg) ((deg)*0.017453292519943295769236907684886)
#define degrees(rad) ((rad)*57.295779513082320876798154814105)
#define sq(x) ((x) * (x))
#define bit(b) (1UL << (b))
#define lowByte(w) ((uint8_t)((w)&0xff))
#define highByte(w) ((uint8_t)((w) >> 8))
#define LED_BUILTIN 13

extern "C" {
void pinMode(pin_size_t pinNumber, PinMode pinMode);
void digitalWrite(pin_size_t pinNumber, PinStatus status);
unsigned long millis(void);
unsigned long micros(void);
void delay(unsigned long);
void yield(void);
void setup(void);
void loop(void);
}

namespace arduino
{

class Print
{
  public:
    virtual ~Print()
    {
    }
    virtual size_t write(uint8_t) = 0;
    virtual size_t write(const uint8_t *buffer, size_t size) = 0;
    virtual int availableForWrite()
    {
        return 0;
    }
    size_t println(const char text[]);
};

class Stream : public Print
{
  public:
    virtual int available() = 0;
    virtual int read() = 0;
    virtual int peek() = 0;
};

class HardwareSerial : public Stream
{
  public:
    virtual void begin(unsigned long) = 0;
    virtual void end() = 0;
    virtual void flush(void) = 0;
    virtual operator bool() = 0;
};

} // namespace arduino

using namespace arduino;

extern HardwareSerial &Serial;

#endif
