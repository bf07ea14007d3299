/* The simulator's links as a host meets them: the path and the port that are printed, every byte value both ways, hosts
 * that come and go, nobody there. */
#define _XOPEN_SOURCE 600 /* fileno, dup, alarm */

#include "port_posix.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "unity.h"

enum { PATIENCE_US = 5000000 };

static el_posix_port port;
static el_port link_of_port;
static uint8_t all_values[256];

/* What an open function prints comes from a file that stands in for the stream. */
static int saved;
static FILE *printed;

static void capture(FILE *stream)
{
    fflush(stream);
    saved = dup(fileno(stream));
    printed = tmpfile();
    TEST_ASSERT_NOT_NULL(printed);
    dup2(fileno(printed), fileno(stream));
}

static void captured(FILE *stream, char *text, int capacity)
{
    fflush(stream);
    dup2(saved, fileno(stream));
    close(saved);
    rewind(printed);
    if (fgets(text, capacity, printed) == NULL) {
        text[0] = '\0';
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(EOF, fgetc(printed), "more than one line");
    fclose(printed);
}

void setUp(void)
{
    for (size_t i = 0; i < sizeof all_values; i++) {
        all_values[i] = (uint8_t)i;
    }
}

void tearDown(void)
{
    el_posix_port_close(&port);
}

static uint32_t now_us(void)
{
    return link_of_port.micros(link_of_port.context);
}

static void device_sends(const uint8_t *bytes, size_t count)
{
    uint32_t begin_us = now_us();
    while (count > 0) {
        int32_t took = link_of_port.write(link_of_port.context, bytes, count);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32_MESSAGE(0, took, strerror(errno));
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(PATIENCE_US, now_us() - begin_us, "the link takes nothing");
        bytes += took;
        count -= (size_t)took;
        link_of_port.wait(link_of_port.context);
    }
}

static void device_receives(const uint8_t *expected, size_t count)
{
    uint8_t bytes[256];
    size_t got = 0;
    uint32_t begin_us = now_us();
    while (got < count) {
        int32_t read_now = link_of_port.read(link_of_port.context, bytes + got, sizeof bytes - got);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32_MESSAGE(0, read_now, strerror(errno));
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(PATIENCE_US, now_us() - begin_us, "the link brings nothing");
        got += (size_t)read_now;
        link_of_port.wait(link_of_port.context);
    }
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, count);
}

static void host_receives(int host, const uint8_t *expected, size_t count)
{
    uint8_t bytes[256];
    size_t got = 0;
    while (got < count) {
        ssize_t now = read(host, bytes + got, count - got);
        TEST_ASSERT_GREATER_THAN_INT(0, (int)now);
        got += (size_t)now;
    }
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, count);
}

/* All byte values in both directions: nothing on the way translates or swallows any. */
static void talk(int host)
{
    device_sends(all_values, sizeof all_values);
    host_receives(host, all_values, sizeof all_values);
    TEST_ASSERT_EQUAL_INT(256, (int)write(host, all_values, sizeof all_values));
    device_receives(all_values, sizeof all_values);
}

/* Fills the link until it takes nothing for a while; returns the bytes that it took. */
static size_t fill(void)
{
    size_t total = 0;
    for (int idle = 0; idle < 20;) {
        int32_t took = link_of_port.write(link_of_port.context, all_values, sizeof all_values);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(0, took);
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(100000000, total, "nobody reads and the link is never full");
        total += (size_t)took;
        idle = took == 0 ? idle + 1 : 0;
        if (took == 0) {
            link_of_port.wait(link_of_port.context);
        }
    }
    return total;
}

/* --- pty ------------------------------------------------------------------------------------------------------- */

static void open_pty(char *path, int capacity)
{
    capture(stdout);
    bool opened = el_posix_port_open_pty(&port);
    captured(stdout, path, capacity);
    TEST_ASSERT_TRUE(opened);
    path[strcspn(path, "\n")] = '\0';
    link_of_port = el_posix_port_link(&port);
}

static void test_pty_hosts_come_and_go(void)
{
    char path[64];
    open_pty(path, sizeof path);
    for (int i = 0; i < 3; i++) {
        int host = open(path, O_RDWR | O_NOCTTY);
        TEST_ASSERT_GREATER_THAN_INT(0, host);
        talk(host);
        close(host);
        uint8_t byte;
        TEST_ASSERT_EQUAL_INT32(0, link_of_port.read(link_of_port.context, &byte, 1));
    }
}

static void test_pty_without_a_host_fills_up(void)
{
    char path[64];
    open_pty(path, sizeof path);
    TEST_ASSERT_LESS_THAN_UINT32(1 << 20, fill());
}

/* --- TCP ------------------------------------------------------------------------------------------------------- */

static uint16_t open_tcp(void)
{
    char text[64];
    capture(stdout);
    bool opened = el_posix_port_open_tcp(&port, 0);
    captured(stdout, text, sizeof text);
    TEST_ASSERT_TRUE(opened);
    static const char prefix[] = "listening on 127.0.0.1:";
    TEST_ASSERT_EQUAL_STRING_LEN(prefix, text, sizeof prefix - 1);
    link_of_port = el_posix_port_link(&port);
    return (uint16_t)strtoul(text + sizeof prefix - 1, NULL, 10);
}

static int connect_to(uint16_t number)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(number)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int host = socket(AF_INET, SOCK_STREAM, 0);
    TEST_ASSERT_EQUAL_INT(0, connect(host, (struct sockaddr *)&address, sizeof address));
    return host;
}

/* The device notices when it reads; what it writes before that is lost with the client. */
static void leave(int host)
{
    uint8_t byte;
    close(host);
    uint32_t begin_us = now_us();
    while (port.in >= 0) {
        TEST_ASSERT_LESS_THAN_UINT32(PATIENCE_US, now_us() - begin_us);
        TEST_ASSERT_EQUAL_INT32(0, link_of_port.read(link_of_port.context, &byte, 1));
        link_of_port.wait(link_of_port.context);
    }
}

static void test_tcp_hosts_come_and_go(void)
{
    uint16_t number = open_tcp();
    for (int i = 0; i < 3; i++) {
        int host = connect_to(number);
        talk(host);
        if (i == 1) { /* one that vanishes while the device writes to it */
            fill();
        }
        leave(host);
    }
}

static void test_tcp_another_client_waits_for_its_turn(void)
{
    uint16_t number = open_tcp();
    int first = connect_to(number);
    talk(first);
    int second = connect_to(number);
    talk(first);
    leave(first);
    talk(second);
    close(second);
}

static void test_tcp_without_a_client_takes_nothing(void)
{
    open_tcp();
    TEST_ASSERT_EQUAL_UINT32(0, fill());
}

static void test_tcp_busy_port_is_one_clear_line(void)
{
    el_posix_port other;
    char text[160];
    char expected[160];
    uint16_t number = open_tcp();

    capture(stderr);
    bool opened = el_posix_port_open_tcp(&other, number);
    captured(stderr, text, sizeof text);
    TEST_ASSERT_FALSE(opened);
    snprintf(expected, sizeof expected,
             "edgeline-sim: cannot listen on 127.0.0.1:%u: Address already in use; choose another --tcp port, or 0 for "
             "any\n",
             number);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

/* --- Standard output ------------------------------------------------------------------------------------------- */

/* A full pipe does not block the device, and its clock stands still; a closed one is a link that is gone, not a signal. */
static void test_stdout_through_a_pipe(void)
{
    int ends[2];
    uint8_t bytes[1000]; /* no part of a pipe's bytes: the last piece is shorter */
    const sig_atomic_t stopped = 1;
    fflush(stdout);
    int terminal = dup(STDOUT_FILENO);
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    dup2(ends[1], STDOUT_FILENO);
    close(ends[1]);

    bool opened = el_posix_port_open_stdout(&port);
    link_of_port = el_posix_port_link(&port);
    device_sends(all_values, sizeof all_values);
    host_receives(ends[0], all_values, sizeof all_values);
    fill();
    const uint32_t full_us = now_us();
    usleep(10000);
    const uint32_t waiting_us = now_us();
    port.stopped = &stopped;
    usleep(10000);
    const uint32_t stopped_us = now_us();
    port.stopped = NULL;
    while (read(ends[0], bytes, sizeof bytes) == (ssize_t)sizeof bytes) {
    }
    const bool takes = link_of_port.write(link_of_port.context, all_values, 1) == 1;
    const uint32_t read_us = now_us();
    usleep(10000);
    const uint32_t later_us = now_us();
    close(ends[0]);
    int32_t took = link_of_port.write(link_of_port.context, all_values, 1);

    dup2(terminal, STDOUT_FILENO);
    close(terminal);
    TEST_ASSERT_TRUE(opened);
    TEST_ASSERT_EQUAL_UINT32(full_us, waiting_us);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(20000, stopped_us - full_us);
    TEST_ASSERT_TRUE(takes);
    TEST_ASSERT_LESS_THAN_UINT32(20000, read_us - full_us);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(10000, later_us - read_us);
    TEST_ASSERT_EQUAL_INT32(-1, took);
}

/* --- Throttle and clock ---------------------------------------------------------------------------------------- */

static uint32_t time_to_send(int host, int pieces)
{
    uint32_t begin_us = now_us();
    for (int i = 0; i < pieces; i++) {
        device_sends(all_values, sizeof all_values);
        host_receives(host, all_values, sizeof all_values);
    }
    return now_us() - begin_us;
}

/* 4,096 bytes take what they take, but for the 1,024 that are in the queue; and when the last bit is out, not before, the
 * rate can be changed. */
static void test_a_link_with_a_rate(void)
{
    char path[64];
    open_pty(path, sizeof path);
    int host = open(path, O_RDWR | O_NOCTTY);
    TEST_ASSERT_NULL(link_of_port.set_baud);
    port.baud = 200000;
    link_of_port = el_posix_port_link(&port);
    uint32_t begin_us = now_us();
    const uint32_t us = time_to_send(host, 16);
    TEST_ASSERT_GREATER_THAN_UINT32(3072 * 50, us);
    TEST_ASSERT_EQUAL_UINT32(1000000, link_of_port.find_baud(link_of_port.context, 1000000));
    while (!link_of_port.set_baud(link_of_port.context, 1000000)) {
        TEST_ASSERT_EQUAL_UINT32(200000, port.baud);
        link_of_port.wait(link_of_port.context);
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(4096 * 50, now_us() - begin_us);
    TEST_ASSERT_EQUAL_UINT32(1000000, port.baud);
    TEST_ASSERT_GREATER_THAN_UINT32(3072 * 10, time_to_send(host, 16));
    close(host);
}

int main(void)
{
    alarm(60); /* a host that waits for bytes that never come ends the test */
    UNITY_BEGIN();
    RUN_TEST(test_pty_hosts_come_and_go);
    RUN_TEST(test_pty_without_a_host_fills_up);
    RUN_TEST(test_tcp_hosts_come_and_go);
    RUN_TEST(test_tcp_another_client_waits_for_its_turn);
    RUN_TEST(test_tcp_without_a_client_takes_nothing);
    RUN_TEST(test_tcp_busy_port_is_one_clear_line);
    RUN_TEST(test_stdout_through_a_pipe);
    RUN_TEST(test_a_link_with_a_rate);
    return UNITY_END();
}
