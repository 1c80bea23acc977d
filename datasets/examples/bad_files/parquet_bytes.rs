//! A Parquet file byte by byte, so that it can claim what no writer would: every number of its footer and page headers is
//! given. With the usual claims it is in order: each column holds one value, once in a dictionary and then as one run.
//!
//! Layout: the Parquet format's `parquet.thrift`, in Thrift's compact protocol.

/// What the file says of itself; of `column`, where only one is spoiled.
#[derive(Debug, Clone)]
pub struct Claims {
    /// Columns of the schema.
    pub columns: Vec<&'static str>,
    /// Which of them the claims below are about; the others are in order.
    pub spoiled: Vec<&'static str>,
    /// Rows that are there.
    pub rows: i64,
    /// Rows of the footer.
    pub footer_rows: i64,
    /// Rows of the group.
    pub group_rows: i64,
    /// Values of the column in the footer, and in its page.
    pub values: i64,
    pub page_values: i64,
    /// Bytes of the page, more than there are.
    pub more_compressed: i64,
    pub more_decompressed: i64,
    /// Bytes that the page lies behind its place, and that the column is longer.
    pub offset: i64,
    pub longer: i64,
    /// 0 is none.
    pub codec: i64,
    /// Columns below the column.
    pub children: i64,
    /// Physical type: 5 is a double.
    pub kind: i64,
    /// Number of groups; all but the first have no rows.
    pub groups: usize,
}

impl Claims {
    /// A file in order with `rows` rows.
    pub fn honest(columns: &[&'static str], rows: i64) -> Claims {
        Claims {
            columns: columns.to_vec(),
            spoiled: columns.to_vec(),
            rows,
            footer_rows: rows,
            group_rows: rows,
            values: rows,
            page_values: rows,
            more_compressed: 0,
            more_decompressed: 0,
            offset: 0,
            longer: 0,
            codec: 0,
            children: 0,
            kind: 5,
            groups: 1,
        }
    }

    /// The file.
    pub fn bytes(&self) -> Vec<u8> {
        let honest = Claims::honest(&self.columns, self.rows);
        let mut file = b"PAR1".to_vec();
        let mut chunks = vec![];
        for column in &self.columns {
            let claims = if self.spoiled.contains(column) { self } else { &honest };
            let start = file.len() as i64;
            file.extend(dictionary());
            let data = file.len() as i64;
            file.extend(page(claims));
            chunks.push(chunk(claims, column, start, data, file.len() as i64 - start));
        }
        let footer = self.footer(&chunks);
        file.extend(&footer);
        file.extend((footer.len() as u32).to_le_bytes());
        file.extend(b"PAR1");
        file
    }

    fn footer(&self, chunks: &[Writer]) -> Vec<u8> {
        let mut root = Writer::default();
        root.text(4, "schema").number(5, 5, self.columns.len() as i64);
        let mut schema = vec![root];
        for column in &self.columns {
            let mut element = Writer::default();
            let spoiled = self.spoiled.contains(column);
            if !(spoiled && self.children > 0) {
                element.number(1, 5, if spoiled { self.kind } else { 5 });
            }
            element.number(3, 5, 0).text(4, column);
            if spoiled && self.children > 0 {
                element.number(5, 5, self.children);
            }
            schema.push(element);
            for child in 0..if spoiled { self.children } else { 0 } {
                let mut below = Writer::default();
                below.number(1, 5, 5).number(3, 5, 0).text(4, &format!("part{child}"));
                schema.push(below);
            }
        }
        let group = |g: usize| {
            let mut group = Writer::default();
            let none = Claims { values: 0, ..Claims::honest(&self.columns, 0) };
            let empty: Vec<Writer> = self.columns.iter().map(|column| chunk(&none, column, 4, 4, 0)).collect();
            let (rows, columns) = if g == 0 { (self.group_rows, chunks) } else { (0, &empty[..]) };
            group.list(1, 12, columns).number(2, 6, 100).number(3, 6, rows);
            group
        };
        let groups: Vec<Writer> = (0..self.groups).map(group).collect();
        let mut footer = Writer::default();
        footer.number(1, 5, 1).list(2, 12, &schema).number(3, 6, self.footer_rows).list(4, 12, &groups);
        footer.end()
    }
}

/// A page with the one value 0.5.
fn dictionary() -> Vec<u8> {
    let (mut header, mut about) = (Writer::default(), Writer::default());
    about.number(1, 5, 1).number(2, 5, 0);
    header.number(1, 5, 2).number(2, 5, 8).number(3, 5, 8).structure(7, &about);
    [header.end(), 0.5f64.to_le_bytes().to_vec()].concat()
}

/// A page with one run of the value's number.
fn page(claims: &Claims) -> Vec<u8> {
    let mut body = vec![1u8];
    varint(&mut body, (claims.page_values.max(0) as u64) << 1);
    body.push(0);
    let (mut header, mut about) = (Writer::default(), Writer::default());
    about.number(1, 5, claims.page_values).number(2, 5, 8).number(3, 5, 3).number(4, 5, 3);
    let size = body.len() as i64;
    header.number(1, 5, 0).number(2, 5, size + claims.more_decompressed).number(3, 5, size + claims.more_compressed);
    header.structure(5, &about);
    [header.end(), body].concat()
}

fn chunk(claims: &Claims, column: &str, start: i64, data: i64, size: i64) -> Writer {
    let mut about = Writer::default();
    about.number(1, 5, claims.kind).numbers(2, &[0, 3, 8]);
    match claims.children {
        0 => about.texts(3, &[column]),
        _ => about.texts(3, &[column, "part0"]),
    };
    about.number(4, 5, claims.codec).number(5, 6, claims.values).number(6, 6, size).number(7, 6, size + claims.longer);
    about.number(9, 6, data + claims.offset).number(11, 6, start + claims.offset);
    let mut chunk = Writer::default();
    chunk.number(2, 6, start).structure(3, &about);
    chunk
}

/// A structure that is being written.
#[derive(Debug, Clone, Default)]
struct Writer {
    bytes: Vec<u8>,
    last: i64,
}

impl Writer {
    fn head(&mut self, field: i64, kind: u8) {
        self.bytes.push(((field - self.last) as u8) << 4 | kind);
        self.last = field;
    }

    /// `kind` 5 is 32 bits, 6 is 64; both are written alike.
    fn number(&mut self, field: i64, kind: u8, value: i64) -> &mut Self {
        self.head(field, kind);
        zigzag(&mut self.bytes, value);
        self
    }

    fn text(&mut self, field: i64, text: &str) -> &mut Self {
        self.head(field, 8);
        bytes(&mut self.bytes, text);
        self
    }

    fn texts(&mut self, field: i64, texts: &[&str]) -> &mut Self {
        self.head(field, 9);
        self.bytes.push((texts.len() as u8) << 4 | 8);
        texts.iter().for_each(|text| bytes(&mut self.bytes, text));
        self
    }

    fn numbers(&mut self, field: i64, numbers: &[i64]) -> &mut Self {
        self.head(field, 9);
        self.bytes.push((numbers.len() as u8) << 4 | 5);
        numbers.iter().for_each(|number| zigzag(&mut self.bytes, *number));
        self
    }

    fn structure(&mut self, field: i64, inner: &Writer) -> &mut Self {
        self.head(field, 12);
        self.bytes.extend(inner.clone().end());
        self
    }

    fn list(&mut self, field: i64, kind: u8, members: &[Writer]) -> &mut Self {
        self.head(field, 9);
        match members.len() {
            short @ 0..15 => self.bytes.push((short as u8) << 4 | kind),
            long => {
                self.bytes.push(0xf0 | kind);
                varint(&mut self.bytes, long as u64);
            }
        }
        members.iter().for_each(|member| self.bytes.extend(member.clone().end()));
        self
    }

    fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn bytes(out: &mut Vec<u8>, text: &str) {
    varint(out, text.len() as u64);
    out.extend(text.as_bytes());
}

fn zigzag(out: &mut Vec<u8>, value: i64) {
    varint(out, (value << 1 ^ value >> 63) as u64);
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}
